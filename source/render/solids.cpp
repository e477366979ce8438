#include "render/solids.h"

#include "core/error.h"
#include "render/shader.h"

#include <cstddef>
#include <utility>

namespace spindrift {

SolidTriangles::SolidTriangles()
    : program_(loadProgram("solids")), array_(makeVertexArray()), corners_(makeBuffer()) {
    for (const auto& [location, offset] : {std::pair{0u, offsetof(SolidShape::Corner, position)},
                                           {1u, offsetof(SolidShape::Corner, normal)}}) {
        glEnableVertexArrayAttrib(array_, location);
        glVertexArrayAttribFormat(array_, location, 3, GL_FLOAT, GL_FALSE, GLuint(offset));
        glVertexArrayAttribBinding(array_, location, 0);
    }
    glVertexArrayVertexBuffer(array_, 0, corners_, 0, sizeof(SolidShape::Corner));
}

void SolidTriangles::upload(std::vector<SolidShape> shapes) {
    shapes_ = std::move(shapes);
    std::vector<SolidShape::Corner> all;
    for (const SolidShape& shape : shapes_)
        all.insert(all.end(), shape.corners.begin(), shape.corners.end());
    glNamedBufferData(corners_, GLsizeiptr(all.size() * sizeof(SolidShape::Corner)), all.data(),
                      GL_STATIC_DRAW);
}

void SolidTriangles::draw(const std::vector<ShapePose>& poses) const {
    CHECK(poses.size() == shapes_.size());
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDisable(GL_BLEND);
    glUseProgram(program_);
    glBindVertexArray(array_);
    GLint first = 0;
    for (size_t s = 0; s < poses.size(); ++s) {
        glUniform3fv(0, 1, &poses[s].middle.x);
        glUniformMatrix3fv(1, 1, GL_FALSE, &poses[s].axis[0].x);
        const auto count = GLsizei(shapes_[s].corners.size());
        glDrawArrays(GL_TRIANGLES, first, count);
        first += count;
    }
}

}  // namespace spindrift
