#pragma once
// What a knob is, and the names of what it can be.
#include "scene/scene.h"

#include <array>

namespace spindrift {

struct Knob {
    const char* unit;  // "" when the value is a plain number, a name or a switch
    float min,
        max;  // both allowed; per component for vectors; no meaning for names, switches and text
    const char* help;
    bool live = true;  // a running simulation takes it over at once; otherwise the scene restarts
};
inline constexpr bool Restart = false;

// The names of an enumeration's values, in their order.
constexpr auto enumNames(Backend) { return std::array{"auto", "cpu", "cuda"}; }
constexpr auto enumNames(Precision) { return std::array{"float", "double"}; }
constexpr auto enumNames(Simd) { return std::array{"auto", "avx512", "avx2", "sse"}; }
constexpr auto enumNames(Formulation) {
    return std::array{"wcsph",   "delta_sph",     "delta_plus", "transport_velocity",
                      "classic", "incompressible"};
}
constexpr auto enumNames(Kernel) {
    return std::array{"wendland_c2", "cubic_spline",   "wendland_c4",
                      "wendland_c6", "quintic_spline", "mueller"};
}
constexpr auto enumNames(PressureForm) { return std::array{"squares", "mean"}; }
constexpr auto enumNames(ViscosityForm) { return std::array{"auto", "morris", "monaghan"}; }
constexpr auto enumNames(EquationOfState) { return std::array{"tait", "linear"}; }
constexpr auto enumNames(WallKind) { return std::array{"reflect", "particles"}; }
constexpr auto enumNames(TimeMode) { return std::array{"fixed", "cfl", "local"}; }
constexpr auto enumNames(Integrator) {
    return std::array{"symplectic_euler", "velocity_verlet", "predictor_corrector", "split"};
}
constexpr auto enumNames(Shape) {
    return std::array{"block", "sphere", "cylinder", "wedge", "plane", "mesh", "file"};
}
constexpr auto enumNames(Axis) { return std::array{"x", "y", "z"}; }
constexpr auto enumNames(Up) { return std::array{"auto", "x", "y", "z", "-x", "-y", "-z"}; }
constexpr auto enumNames(ColorBy) {
    return std::array{"plain",        "velocity",   "pressure",   "density",
                      "acceleration", "id",         "fluid",      "surface",
                      "velocity_x",   "velocity_y", "velocity_z", "vorticity",
                      "shear_rate",   "divergence", "neighbours", "time_bin"};
}
constexpr auto enumNames(DrawStyle) { return std::array{"spheres", "surface"}; }
constexpr auto enumNames(ColorMap) {
    return std::array{"viridis", "cividis", "turbo", "coolwarm", "file"};
}
constexpr auto enumNames(ColorScale) { return std::array{"linear", "logarithmic"}; }
constexpr auto enumNames(Theme) { return std::array{"dark", "light"}; }
constexpr auto enumNames(Projection) { return std::array{"perspective", "orthographic"}; }
constexpr auto enumNames(Across) { return std::array{"none", "x", "y", "z"}; }
constexpr auto enumNames(Field) {
    return std::array{"uniform", "taylor_green", "stretching",   "rotation",
                      "shear",   "sound_wave",   "standing_wave"};
}
constexpr auto enumNames(StartPlaces) { return std::array{"lattice", "relaxed"}; }
constexpr auto enumNames(StartPressure) { return std::array{"none", "hydrostatic"}; }
constexpr auto enumNames(Face) {
    return std::array{"none", "x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
}
constexpr auto enumNames(RangeMode) { return std::array{"frame", "run", "fixed"}; }

constexpr auto enumNames(StirMode) { return std::array{"drag", "attract", "repel"}; }

constexpr auto enumNames(ProbeKind) { return std::array{"point", "line", "height", "front"}; }
constexpr auto enumNames(ObjectShape) { return std::array{"block", "sheet", "tube", "shell"}; }
constexpr auto enumNames(Mouth) { return std::array{"rectangle", "disc"}; }
constexpr auto enumNames(Profile) { return std::array{"uniform", "parabolic"}; }
constexpr auto enumNames(Order) { return std::array{"mean", "linear"}; }

}  // namespace spindrift
