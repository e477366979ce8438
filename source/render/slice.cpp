#include "render/slice.h"

#include "render/shader.h"

namespace spindrift {

SlicePlane::SlicePlane() : program_(loadProgram("slice")), empty_(makeVertexArray()) {}

void SlicePlane::upload(const SliceField& field) {
    if (field.columns != columns_ || field.rows != rows_) {
        field_ = makeTexture(GL_TEXTURE_2D);
        glTextureStorage2D(field_, 1, GL_RG32F, field.columns, field.rows);
        glTextureParameteri(field_, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        glTextureParameteri(field_, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
        glTextureParameteri(field_, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
        glTextureParameteri(field_, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
        columns_ = field.columns, rows_ = field.rows;
    }
    glTextureSubImage2D(field_, 0, 0, 0, columns_, rows_, GL_RG, GL_FLOAT, field.points.data());
}

void SlicePlane::draw(const SliceField& field, GLuint tables, float contourStep, bool smooth) {
    if (field.points.empty()) return;
    upload(field);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    if (smooth) glEnable(GL_SAMPLE_ALPHA_TO_COVERAGE);
    glUseProgram(program_);
    glBindTextureUnit(0, tables);
    glBindTextureUnit(1, field_);
    glUniform3fv(0, 1, &field.corner.x);
    glUniform3fv(1, 1, &field.across.x);
    glUniform3fv(2, 1, &field.along.x);
    glUniform1f(3, contourStep);
    glBindVertexArray(empty_);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glDisable(GL_SAMPLE_ALPHA_TO_COVERAGE);
}

}  // namespace spindrift
