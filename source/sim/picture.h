// The vertices that the screen shows. Included by simulation_on.h.
#pragma once

namespace spindrift::LANES {

// The bin in which so many values are passed, from below.
inline int binAfter(const std::vector<int>& counts, int values) {
    int bin = 0;
    const int last = int(counts.size()) - 1;
    for (int n = counts[0]; n <= values && bin < last; n += counts[size_t(bin)]) ++bin;
    return bin;
}

// Half a per cent of the values on either side are outliers. With `bulk` so are those beyond
// Tukey's fences, one and a half times the range of the middle half away from it: density of spray
// says nothing of the fluid.
inline Range withoutOutliers(ValueRange range, const std::vector<int>& counts, bool bulk) {
    const int all = std::accumulate(counts.begin(), counts.end(), 0), last = int(counts.size()) - 1;
    const std::vector<int> reversed(counts.rbegin(), counts.rend());
    int low = binAfter(counts, all / 200), high = last - binAfter(reversed, all / 200);
    if (bulk) {
        const int quarter = binAfter(counts, all / 4), most = last - binAfter(reversed, all / 4);
        const int reach = 3 * (most - quarter + 1) / 2;
        low = std::max(low, quarter - reach), high = std::min(high, most + reach);
    }
    const float bin = (range.high - range.low) / float(last);
    return {range.low + bin * float(low), std::min(range.high, range.low + bin * float(high + 1))};
}

template <class Device>
Range SimulationOn<Device>::writeVertices(Vertex* out, ColorBy by, int walls) {
    const View v = view();
    if (walls > 0)
        device_.forEach(v.walls.slots,
                        WriteWallVertices{v, solids_.home(), out,
                                          fluidCount_ + solidParticleCount(), fluidCount_ + walls});
    if (objects_.count() > 0)
        objects_.writeVertices(out + fluidCount_ + walls, scene_.simulation.spacing);
    switch (by) {
        case ColorBy::Plain:
            return write<PlainValue>(v.fluid, out);
        case ColorBy::Velocity:
            return write<SpeedValue>(v.fluid, out);
        case ColorBy::Pressure:
            return write<PressureValue>(v.fluid, out);
        case ColorBy::Density:
            return write<DensityValue>(v.fluid, out);
        case ColorBy::Acceleration:
            return write<AccelerationValue>(v.fluid, out);
        case ColorBy::Id:
            return write<IdValue>(v.fluid, out);
        case ColorBy::Fluid:
            return write<FluidValue>(v.fluid, out);
        case ColorBy::Surface:
            return writeSurface(out);
    }
    return {0, 0};
}

// Found when somebody looks. (With local steps not where fluid rests: lists are missing there.)
template <class Device> Range SimulationOn<Device>::writeSurface(Vertex* out) {
    showsSurface_ = true;
    addBuffers();
    (this->*pairPass<ComputeNormals>())();
    onFluid<TagSurface>();
    (this->*pairPass<LeaveOutSpray>())();
    return write<SurfaceValue>(fluid_.view(), out);
}

template <class Device> template <class Value>
Range SimulationOn<Device>::write(const Particles& p, Vertex* out) {
    const auto range = device_.template sum<ValueRange>(p.slots, WriteVertices<Value>{p, out});
    if (!(range.high > range.low)) return {range.low, range.high};
    const std::vector<int> counts = device_.histogram(p.slots, CountValues<Value>{p, range});
    return withoutOutliers(range, counts, std::is_same_v<Value, DensityValue>);
}

}  // namespace spindrift::LANES
