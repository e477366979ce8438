#pragma once
// The figures of an earlier `spindrift bench` on the same machine.
#include <nlohmann/json.hpp>

#include <string>

namespace spindrift {

// What rows are compared by: processor and number of cores, as the system names them.
std::string machineName();

class BenchBaseline {
public:
    // Slower than this is worth a word; what is less lies in the noise of a machine with other
    // work.
    static constexpr double tolerance = 1.1;

    BenchBaseline() = default;
    // The rows that an earlier run wrote to `path`; none when there is no such file. Throws
    // Error(Failure::Usage) when it is something else.
    explicit BenchBaseline(const std::string& path);

    // Takes a row that has no match yet; returns whether it was one.
    bool add(const nlohmann::json& row);
    std::string text() const { return rows_.dump(2) + "\n"; }
    // The row of the same case, machine and device with the same number of particles, or null.
    const nlohmann::json* find(const nlohmann::json& row) const;
    // Time a step as a multiple of the baseline's, 0 where that has no such row.
    double ratio(const nlohmann::json& row) const;
    // A line for a row that is slower by more than the tolerance, with the passes to blame; "" for
    // others.
    std::string complaint(const nlohmann::json& row) const;

private:
    nlohmann::json rows_ = nlohmann::json::array();
};

}  // namespace spindrift
