#pragma once
// DejaVu Sans as pixels: one atlas for one text size.
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace spindrift {

// Where a character stands in the atlas and relative to the pen, in pixels.
struct Glyph {
    int x = 0, y = 0, width = 0, height = 0;
    float left = 0, top = 0, advance = 0;
};

class Font {
public:
    static constexpr int side = 512;  // of the atlas
    static constexpr int disc = 32;  // a filled circle in its upper left corner, for rounded shapes

    // Without the font file there are no characters; that is said once on standard error.
    explicit Font(float pixels);
    float pixels() const { return pixels_; }
    const std::vector<uint8_t>& atlas() const { return atlas_; }
    const Glyph& glyph(char32_t c) const { return glyphs_[c < 256 ? c : '?']; }

private:
    void drawDisc();
    void drawGlyphs(const std::vector<uint8_t>& file);

    float pixels_;
    std::vector<uint8_t> atlas_;
    std::array<Glyph, 256> glyphs_{};  // Latin-1
};

// Takes the first character off UTF-8 text.
char32_t takeCharacter(std::string_view& text);

// The font's file, or an empty text when it isn't installed.
std::string_view fontPath();

}  // namespace spindrift
