// The vertices that the screen shows. Included by simulation_on.h.
#pragma once

namespace spindrift::LANES {

inline Range withoutOutliers(ValueRange range, const std::vector<int>& counts) {
    const int all = std::accumulate(counts.begin(), counts.end(), 0), outliers = all / 200;
    int low = 0, high = int(counts.size()) - 1;
    for (int n = counts[low]; n <= outliers && low < high; n += counts[low]) ++low;
    for (int n = counts[high]; n <= outliers && high > low; n += counts[high]) --high;
    const float bin = (range.high - range.low) / float(counts.size() - 1);
    return {range.low + bin * float(low), std::min(range.high, range.low + bin * float(high + 1))};
}

template <class Device> Range SimulationOn<Device>::writeVertices(Vertex* out, ColorBy by, int walls) {
    const View v = view();
    if (walls > 0)
        device_.forEach(v.walls.slots, WriteWallVertices{v.walls, out, fluidCount_ + solidParticleCount(), fluidCount_ + walls});
    if (objects_.count() > 0) objects_.writeVertices(out + fluidCount_ + walls, scene_.simulation.spacing);
    switch (by) {
        case ColorBy::Plain: return write<PlainValue>(v.fluid, out);
        case ColorBy::Velocity: return write<SpeedValue>(v.fluid, out);
        case ColorBy::Pressure: return write<PressureValue>(v.fluid, out);
        case ColorBy::Density: return write<DensityValue>(v.fluid, out);
        case ColorBy::Acceleration: return write<AccelerationValue>(v.fluid, out);
        case ColorBy::Id: return write<IdValue>(v.fluid, out);
        case ColorBy::Fluid: return write<FluidValue>(v.fluid, out);
        case ColorBy::Surface: return writeSurface(out);
    }
    return {0, 0};
}

// Found when somebody looks. (With local steps not where fluid rests: lists are missing there.)
template <class Device> Range SimulationOn<Device>::writeSurface(Vertex* out) {
    showsSurface_ = true;
    addBuffers();
    (this->*pairPass<ComputeNormals>())();
    onFluid<TagSurface>();
    return write<SurfaceValue>(fluid_.view(), out);
}

template <class Device> template <class Value> Range SimulationOn<Device>::write(const Particles& p, Vertex* out) {
    const auto range = device_.template sum<ValueRange>(p.slots, WriteVertices<Value>{p, out});
    if (!(range.high > range.low)) return {range.low, range.high};
    return withoutOutliers(range, device_.histogram(p.slots, CountValues<Value>{p, range}));
}

}  // namespace spindrift::LANES
