#include "samples/viewer/statistics_file.hpp"

#include "voile/engine/assets/file.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace viewer
{
namespace
{

using Json = nlohmann::ordered_json; // keys in the order of the README

Json number(double value)
{
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json count(const std::optional<uint64_t>& value)
{
    return value ? Json(*value) : Json(nullptr);
}

Json pair(const Percentiles& values)
{
    return {{"median", number(values.median)}, {"p95", number(values.p95)}};
}

Json measurements_json(const Measurements& values)
{
    return {{"max_stretch", number(values.max_stretch)},
            {"mean_stretch", number(values.mean_stretch)},
            {"kinetic_energy", number(values.kinetic_energy)},
            {"penetrating_vertices", count(values.penetrating_vertices)},
            {"deepest_penetration", number(values.deepest_penetration)},
            {"intersecting_cloth_pairs", count(values.intersections.cloth)},
            {"intersecting_collider_pairs", count(values.intersections.collider)},
            {"uncertain_pairs", count(values.intersections.uncertain)},
            {"nan_vertices", count(values.nan_vertices)},
            {"contacts", count(values.contacts)},
            {"candidates", count(values.candidates)},
            {"contact_overflows", count(values.contact_overflows)},
            {"forced_pairs", count(values.forced_pairs)},
            {"tangled_pairs", count(values.tangled_pairs)},
            {"pair_searches", count(values.pair_searches)},
            {"sleeping_cloths", count(values.sleeping_cloths)}};
}

Json summary_json(const StatisticsSummary& summary)
{
    Json passes = Json::object();
    for (const auto& [name, milliseconds] : summary.gpu_pass_ms)
        passes[name] = number(milliseconds);
    Json gpu = {{"frame", pair(summary.gpu_frame_ms)}, {"cloth", pair(summary.gpu_cloth_ms)}};
    gpu["passes"] = std::move(passes);
    Json last = measurements_json(summary.last);
    last["self_intersections"] = count(summary.self_intersections);
    last["verified"] = summary.verified;
    Json result = {{"substeps_per_frame", summary.substeps_per_frame},
                   {"vertices", summary.vertices},
                   {"triangles", summary.triangles}};
    result["last"] = std::move(last);
    result["maxima"] = measurements_json(summary.maxima);
    result["gpu_ms"] = std::move(gpu);
    result["cpu_record_ms"] = pair(summary.cpu_record_ms);
    result["state_hash"] = hash_text(summary.state_hash);
    return result;
}

Json frame_json(const FrameStatistics& frame)
{
    Json result = {{"frame", frame.frame}, {"substeps", frame.substeps}};
    result.update(measurements_json(frame));
    result["gpu_frame_ms"] = number(frame.gpu_frame_ms);
    result["gpu_cloth_ms"] = number(frame.gpu_cloth_ms);
    result["cpu_record_ms"] = number(frame.cpu_record_ms);
    return result;
}

std::string dump(const Json& json, int indent)
{
    // A driver's name need not be valid UTF-8; a replaced character is better than no statistics.
    return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

std::vector<double> sorted_finite(std::span<const double> values)
{
    std::vector<double> sorted;
    std::copy_if(values.begin(), values.end(), std::back_inserter(sorted), [](double v) { return std::isfinite(v); });
    std::sort(sorted.begin(), sorted.end());
    return sorted;
}

} // namespace

double median(std::span<const double> values)
{
    const std::vector<double> sorted = sorted_finite(values);
    if (sorted.empty())
        return k_not_measured;
    const size_t middle = sorted.size() / 2;
    return sorted.size() % 2 == 1 ? sorted[middle] : 0.5 * (sorted[middle - 1] + sorted[middle]);
}

double p95(std::span<const double> values)
{
    const std::vector<double> sorted = sorted_finite(values);
    if (sorted.empty())
        return k_not_measured;
    const size_t rank = (sorted.size() * 95 + 99) / 100; // rounded up, from 1
    return sorted[rank - 1];
}

Measurements larger_of(const Measurements& a, const Measurements& b)
{
    // fmax leaves out what was not measured, and an empty optional is below any number.
    return {std::fmax(a.max_stretch, b.max_stretch),
            std::fmax(a.mean_stretch, b.mean_stretch),
            std::fmax(a.kinetic_energy, b.kinetic_energy),
            std::max(a.penetrating_vertices, b.penetrating_vertices),
            std::fmax(a.deepest_penetration, b.deepest_penetration),
            {std::max(a.intersections.cloth, b.intersections.cloth),
             std::max(a.intersections.collider, b.intersections.collider),
             std::max(a.intersections.uncertain, b.intersections.uncertain)},
            std::max(a.nan_vertices, b.nan_vertices),
            std::max(a.contacts, b.contacts),
            std::max(a.candidates, b.candidates),
            std::max(a.contact_overflows, b.contact_overflows),
            std::max(a.forced_pairs, b.forced_pairs),
            std::max(a.tangled_pairs, b.tangled_pairs),
            std::max(a.pair_searches, b.pair_searches),
            std::max(a.sleeping_cloths, b.sleeping_cloths)};
}

Percentiles percentiles(std::span<const double> values)
{
    return {median(values), p95(values)};
}

void StateHash::add(std::span<const std::byte> bytes)
{
    for (const std::byte byte : bytes)
    {
        value_ ^= static_cast<uint64_t>(byte);
        value_ *= 0x100000001b3u;
    }
}

std::string hash_text(uint64_t hash)
{
    std::array<char, 17> text{};
    (void)std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(hash));
    return text.data();
}

std::string statistics_text(const Statistics& statistics)
{
    const Json head = {{"scene", statistics.scene},
                       {"device", statistics.device},
                       {"driver", statistics.driver},
                       {"frames", statistics.frames},
                       {"summary", summary_json(statistics.summary)}};
    std::string text = dump(head, 1);
    // A line a frame: readable, and a run of thousands stays small.
    text.resize(text.rfind('\n'));
    text += ",\n \"per_frame\": [";
    for (size_t i = 0; i < statistics.per_frame.size(); ++i)
        text += (i == 0 ? "\n  " : ",\n  ") + dump(frame_json(statistics.per_frame[i]), -1);
    return text + (statistics.per_frame.empty() ? "]\n}\n" : "\n ]\n}\n");
}

voile::Result<void> save_statistics(const std::filesystem::path& path, const Statistics& statistics)
{
    return voile::engine::write_file(path, statistics_text(statistics));
}

} // namespace viewer
