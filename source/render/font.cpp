#include "render/font.h"

#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_truetype.h>
#pragma GCC diagnostic pop

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace spindrift {

std::string_view fontPath() {
    for (const char* path : {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                             "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
                             "/usr/share/fonts/TTF/DejaVuSans.ttf"})
        if (std::filesystem::exists(path)) return path;
    static const bool said = std::fputs(
        "spindrift: no text in pictures: install the font DejaVu Sans (fonts-dejavu-core)\n",
        stderr);
    (void)said;
    return {};
}

Font::Font(float pixels) : pixels_(pixels), atlas_(size_t(side) * side) {
    drawDisc();
    if (fontPath().empty()) return;
    std::ifstream file(std::string(fontPath()), std::ios::binary);
    drawGlyphs({std::istreambuf_iterator<char>(file), {}});
}

void Font::drawDisc() {
    const float radius = 0.5f * disc;
    for (int y = 0; y < disc; ++y)
        for (int x = 0; x < disc; ++x) {
            const float d = std::hypot(float(x) + 0.5f - radius, float(y) + 0.5f - radius);
            atlas_[size_t(y) * side + x] = uint8_t(255 * std::clamp(radius - d + 0.5f, 0.0f, 1.0f));
        }
}

void Font::drawGlyphs(const std::vector<uint8_t>& file) {
    stbtt_fontinfo font;
    if (file.empty() || !stbtt_InitFont(&font, file.data(), 0)) return;
    const float scale = stbtt_ScaleForMappingEmToPixels(&font, pixels_);
    int penX = disc + 2, penY = 0, rowHeight = disc;
    for (int c = 32; c < 256; ++c) {
        int x0, y0, x1, y1, advance, bearing;
        stbtt_GetCodepointBitmapBox(&font, c, scale, scale, &x0, &y0, &x1, &y1);
        stbtt_GetCodepointHMetrics(&font, c, &advance, &bearing);
        Glyph glyph{0, 0, x1 - x0, y1 - y0, float(x0), float(y0), float(advance) * scale};
        if (penX + glyph.width + 1 > side) {
            penX = 0;
            penY += rowHeight + 1;
            rowHeight = 0;
        }
        if (penY + glyph.height > side) return;  // too large a text: the rest of Latin-1 stays out
        glyph.x = penX;
        glyph.y = penY;
        stbtt_MakeCodepointBitmap(&font, &atlas_[size_t(penY) * side + penX], glyph.width,
                                  glyph.height, side, scale, scale, c);
        penX += glyph.width + 1;
        rowHeight = std::max(rowHeight, glyph.height);
        glyphs_[size_t(c)] = glyph;
    }
}

char32_t takeCharacter(std::string_view& text) {
    const auto byte = [&](size_t i) { return i < text.size() ? uint8_t(text[i]) : uint8_t(0); };
    const int length = byte(0) < 0x80 ? 1 : byte(0) < 0xe0 ? 2 : byte(0) < 0xf0 ? 3 : 4;
    char32_t c = length == 1 ? byte(0) : byte(0) & (0xff >> (length + 1));
    for (int i = 1; i < length; ++i) c = c << 6 | (byte(size_t(i)) & 0x3f);
    text.remove_prefix(std::min(text.size(), size_t(length)));
    return c;
}

}  // namespace spindrift
