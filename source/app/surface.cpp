#include "app/surface.h"

#include "app/exit_code.h"
#include "app/surface_file.h"
#include "core/error.h"
#include "core/output_file.h"
#include "scene/particle_file.h"
#include "scene/particle_spacing.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <set>

namespace spindrift {
namespace {

namespace fs = std::filesystem;

// ply, obj or vdb.
std::string formatOf(const SurfaceOptions& options) {
    const std::string kind = fs::path(options.out).extension().string(),
                      named = kind.empty() ? "" : kind.substr(1);
    const std::string format = !options.format.empty() ? options.format
                               : !named.empty()        ? named
                                                       : "ply";
    const auto& formats = surfaceFormats();
    if (std::find(formats.begin(), formats.end(), format) == formats.end())
        throw Error(Failure::Usage,
                    fmt::format("surface: \"{}\" is no format; take ply, obj or vdb", format));
    if (!named.empty() && named != format)
        throw Error(Failure::Usage,
                    fmt::format("surface: --out {} is no {}; name it .{}, or a folder without a .",
                                options.out, format, format));
    return format;
}

// Where the surface of each table goes: one file, or into a folder under the table's name. A name
// without an extension is a folder's.
std::vector<std::string> targetsOf(const SurfaceOptions& options, const std::string& format) {
    if (fs::path(options.out).has_extension()) {
        if (options.files.size() > 1)
            throw Error(Failure::Usage,
                        fmt::format("surface: {} tables can't become one {}; name a folder",
                                    options.files.size(), options.out));
        return {options.out};
    }
    if (!options.out.empty()) requireFolder(options.out);
    std::vector<std::string> targets;
    std::set<std::string> taken;
    for (const std::string& file : options.files) {
        fs::path target = fs::path(file).replace_extension(format);
        if (!options.out.empty()) target = options.out / target.filename();
        if (!taken.insert(target.string()).second)
            throw Error(Failure::Usage,
                        fmt::format("surface: two files would become {}; give each a name of its "
                                    "own",
                                    target.string()));
        targets.push_back(target.string());
    }
    return targets;
}

double spacingOf(const std::string& file, const std::vector<Vec3d>& places, double asked) {
    const auto [low, high] = std::minmax_element(
        places.begin(), places.end(), [](const Vec3d& a, const Vec3d& b) { return a.z < b.z; });
    if (!places.empty() && low->z == high->z)
        throw Error(Failure::Usage,
                    file + ": its particles lie in a plane; a surface needs three dimensions");
    const double spacing = asked > 0 ? asked : spacingBetween(places, 3);
    if (!(spacing > 0))
        throw Error(Failure::Usage,
                    file + ": its particles don't say how far they are apart; give --spacing");
    return spacing;
}

// m^3, by the masses and densities that the table has, else by the spacing.
double volumeOf(const ParticleTable& table, double spacing) {
    double volume = 0;
    for (size_t i = 0; i < table.positions.size(); ++i) {
        const bool weighed = !table.masses.empty() && !table.densities.empty();
        volume += weighed && table.densities[i] > 0 ? table.masses[i] / table.densities[i]
                                                    : spacing * spacing * spacing;
    }
    return volume;
}

void makeSurface(const std::string& file, const std::string& target,
                 const SurfaceOptions& options) {
    const auto begin = std::chrono::steady_clock::now();
    const ParticleTable table = readParticles(file);
    const double spacing = spacingOf(file, table.positions, options.spacing),
                 volume = volumeOf(table, spacing);
    const SurfaceFile surface(table.positions, spacing, volume, options.method);
    if (surface.triangles() == 0)
        throw Error(Failure::Usage, file + ": no surface was found; is --spacing right?");
    surface.write(target);
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    fmt::print("{}: {} particles, {} triangles, {:.4g} m^3 of {:.4g}, {:.2g} s\n", target,
               table.positions.size(), surface.triangles(), surface.volume(), volume, seconds);
}

}  // namespace

int makeSurfaces(const SurfaceOptions& options) {
    const std::string format = formatOf(options);
    const std::vector<std::string> targets = targetsOf(options, format);
    for (const std::string& target : targets) requireWritable(target);
    for (size_t k = 0; k < targets.size(); ++k) makeSurface(options.files[k], targets[k], options);
    return int(Exit::Ok);
}

}  // namespace spindrift
