#include "app/bench_baseline.h"

#include "core/error.h"
#include "core/system.h"

#include <fmt/format.h>

#include <fstream>
#include <thread>

namespace spindrift {

std::string machineName() {
    return fmt::format("{}, {} cores", os::processorName(), std::thread::hardware_concurrency());
}

BenchBaseline::BenchBaseline(const std::string& path) {
    std::ifstream file(path);
    if (!file) return;
    rows_ = nlohmann::json::parse(file, nullptr, false);
    if (!rows_.is_array())
        throw Error(
            Failure::Usage,
            path +
                ": is not what bench --json writes; remove it, and the next run begins a new one");
}

const nlohmann::json* BenchBaseline::find(const nlohmann::json& row) const {
    for (const nlohmann::json& old : rows_) {
        if (!old.is_object() || !old.contains("ms_per_pass") || !old["ms_per_pass"].is_object())
            continue;
        if (!old.contains("ms_per_step") || !old["ms_per_step"].is_number()) continue;
        const auto same = [&](const char* key) {
            return old.contains(key) && old[key] == row.at(key);
        };
        if (same("case") && same("machine") && same("device") && same("particles")) return &old;
    }
    return nullptr;
}

bool BenchBaseline::add(const nlohmann::json& row) {
    if (find(row)) return false;
    rows_.push_back(row);
    return true;
}

double BenchBaseline::ratio(const nlohmann::json& row) const {
    const nlohmann::json* old = find(row);
    return old ? row.at("ms_per_step").get<double>() / old->at("ms_per_step").get<double>() : 0;
}

std::string BenchBaseline::complaint(const nlohmann::json& row) const {
    const double now = ratio(row);
    if (now <= tolerance) return "";
    std::string passes;
    const nlohmann::json& before = find(row)->at("ms_per_pass");
    for (const auto& [name, ms] : row.at("ms_per_pass").items()) {
        const double old = before.value(name, 0.0), change = ms.get<double>() - old;
        if (change > 0.02 * row.at("ms_per_step").get<double>())
            passes += fmt::format("{}{} {:.3f} -> {:.3f}", passes.empty() ? "" : ", ", name, old,
                                  ms.get<double>());
    }
    return fmt::format("{}: {:.3f} ms a step, {:.2f} times the baseline's{}",
                       row.at("case").get<std::string>(), row.at("ms_per_step").get<double>(), now,
                       passes.empty() ? "" : " (" + passes + ")");
}

}  // namespace spindrift
