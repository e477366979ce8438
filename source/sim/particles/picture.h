// The vertices that the screen shows.
#pragma once

#include "sim/step/flow.h"
#include "sim/particles/output_passes.h"
#include "sim/physics/surface.h"
#include "sim/physics/velocity_gradient.h"

#include <algorithm>
#include <numeric>
#include <type_traits>
#include <vector>

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

// A GPU is waited for once, for the range and how values are spread over it.
template <class Value, class Device> Range write(Flow<Device>& flow, VertexPlaces out) {
    const Particles p = flow.fluid.view();
    ValueRange range, *there = flow.valueRange.data();
    flow.device.reduce(p.slots, WriteVertices<Value>{p, out}, there);
    flow.device.fetch(&range, there, 1);
    const std::vector<int> counts = flow.device.histogram(p.slots, CountValues<Value>{p, there});
    if (range.high < range.low) return {0, 0};  // there is none
    if (!(range.high > range.low)) return {range.low, range.high};
    return withoutOutliers(range, counts, std::is_same_v<Value, DensityValue>);
}

// Found when a picture asks. (With block time steps not where fluid rests: lists are missing
// there.)
template <class Device> Range writeSurface(Flow<Device>& flow, VertexPlaces out) {
    flow.template onPairsOrFluid<ComputeNormals>();
    flow.template onFluid<TagSurface>();
    flow.template onPairsOrFluid<LeaveOutSpray>();
    return write<FoundValue>(flow, out);
}

// Of what the pass finds for each particle from all its neighbours.
template <class Pass, class Device> Range writeFound(Flow<Device>& flow, VertexPlaces out) {
    flow.search.amongFluid(flow.view(), [&](const View& v) {
        if constexpr (requires { typename Pass::Parameters; })
            flow.device.forEach(flow.fluid.slots(), Pass{v, Pass::Parameters::of(flow.model)});
        else
            flow.device.forEach(flow.fluid.slots(), Pass{v});
    });
    return write<FoundValue>(flow, out);
}

// What asks for neighbours.
template <class Device> Range writeFoundOf(Flow<Device>& flow, VertexPlaces out, ColorBy by) {
    flow.showsFound = true;
    flow.addBuffers();
    switch (by) {
        case ColorBy::Surface:
            return writeSurface(flow, out);
        case ColorBy::Vorticity:
            return writeFound<FromVelocityGradient<VorticityOf>>(flow, out);
        case ColorBy::ShearRate:
            return writeFound<FromVelocityGradient<ShearRateOf>>(flow, out);
        case ColorBy::Divergence:
            return writeFound<FromVelocityGradient<DivergenceOf>>(flow, out);
        default:
            return writeFound<CountNeighbours>(flow, out);
    }
}

template <class Device> Range writeFluid(Flow<Device>& flow, VertexPlaces out, ColorBy by) {
    switch (by) {
        case ColorBy::Plain:
            return write<PlainValue>(flow, out);
        case ColorBy::Velocity:
            return write<SpeedValue>(flow, out);
        case ColorBy::Pressure:
            return write<PressureValue>(flow, out);
        case ColorBy::Density:
            return write<DensityValue>(flow, out);
        case ColorBy::Acceleration:
            return write<AccelerationValue>(flow, out);
        case ColorBy::Id:
            return write<IdValue>(flow, out);
        case ColorBy::Fluid:
            return write<FluidValue>(flow, out);
        case ColorBy::VelocityX:
            return write<VelocityComponent<0>>(flow, out);
        case ColorBy::VelocityY:
            return write<VelocityComponent<1>>(flow, out);
        case ColorBy::VelocityZ:
            return write<VelocityComponent<2>>(flow, out);
        case ColorBy::TimeBin:
            return write<TimeBinValue>(flow, out);
        case ColorBy::Surface:
        case ColorBy::Vorticity:
        case ColorBy::ShearRate:
        case ColorBy::Divergence:
        case ColorBy::Neighbours:
            return writeFoundOf(flow, out, by);
    }
    return {0, 0};
}

}  // namespace spindrift::LANES
