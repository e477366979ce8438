#pragma once
// A picture in memory and PNG files.
#include <cstdint>
#include <string>
#include <vector>

namespace spindrift {

struct Image {
    int width = 0, height = 0;
    std::vector<uint8_t> rgb;  // 3 bytes a pixel, rows from the top
    bool operator==(const Image&) const = default;
};

// Throws Error (Scene: it's an input) when the file is missing or no PNG. Grey and alpha become
// RGB.
Image readPng(const std::string& path);
// As all outputs (core/output_file.h). Throws Error (Output).
void writePng(const std::string& path, const Image&);

}  // namespace spindrift
