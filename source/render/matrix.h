#pragma once
// 4x4 matrices as OpenGL wants them: column by column.
#include "core/vec.h"

#include <array>

namespace spindrift {

struct Mat4 {
    std::array<float, 16> m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    float& at(int row, int column) { return m[size_t(column * 4 + row)]; }
    float at(int row, int column) const { return m[size_t(column * 4 + row)]; }
};

inline Mat4 operator*(const Mat4& a, const Mat4& b) {
    Mat4 c;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) {
            float sum = 0;
            for (int k = 0; k < 4; ++k) sum += a.at(row, k) * b.at(k, column);
            c.at(row, column) = sum;
        }
    return c;
}

}  // namespace spindrift
