#include "render/color_map.h"

#include <gtest/gtest.h>

namespace spindrift {
namespace {

double luminance(const std::array<uint8_t, 3>& c) {
    return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
}

TEST(ColorMap, EndsAreThePublishedOnes) {
    const std::array<uint8_t, 3> first = colorTable(ColorMap::Viridis)[0],
                                 last = colorTable(ColorMap::Viridis)[255];
    EXPECT_EQ(first, (std::array<uint8_t, 3>{0x44, 0x01, 0x54}));
    EXPECT_EQ(last, (std::array<uint8_t, 3>{0xfd, 0xe7, 0x25}));
    EXPECT_EQ(colorTable(ColorMap::Coolwarm)[0], (std::array<uint8_t, 3>{0x3b, 0x4c, 0xc0}));
}

TEST(ColorMap, ViridisAndCividisGrowBrighterAllTheWay) {
    for (ColorMap map : {ColorMap::Viridis, ColorMap::Cividis}) {
        const ColorTable table = colorTable(map);
        for (size_t i = 8; i < table.size(); ++i)
            EXPECT_GT(luminance(table[i]), luminance(table[i - 8]))
                << colorMapName(map) << " at " << i;
    }
}

TEST(ColorMap, NeighboursAreClose) {
    for (int map = 0; map < colorMapCount; ++map) {
        const ColorTable table = colorTable(ColorMap(map));
        for (size_t i = 1; i < table.size(); ++i)
            for (size_t k = 0; k < 3; ++k)
                EXPECT_LE(std::abs(table[i][k] - table[i - 1][k]), 8)
                    << colorMapName(ColorMap(map));
    }
}

}  // namespace
}  // namespace spindrift
