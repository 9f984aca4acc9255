// viewer: simulates a scene and shows it, in a window or as files. The story of a run is run_scene.
#include "samples/viewer/animation_exports.hpp"
#include "samples/viewer/controls.hpp"
#include "samples/viewer/exports.hpp"
#include "samples/viewer/frame_outputs.hpp"
#include "samples/viewer/output_check.hpp"
#include "samples/viewer/panel.hpp"
#include "samples/viewer/progress.hpp"
#include "samples/viewer/softening_notes.hpp"
#include "samples/viewer/text.hpp"
#include "samples/viewer/verify.hpp"
#include "samples/viewer/watched_shaders.hpp"

#include "voile/engine/app/signals.hpp"
#include "voile/engine/gpu/capture.hpp"
#include "voile/gpu/printable.hpp"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <iostream>
#include <iterator>
#include <sstream>

namespace
{

using namespace viewer;

constexpr int k_done = 0;
constexpr int k_failed = 1;
constexpr int k_invalid = 2; // validation messages, or values that are not finite
constexpr int k_interrupted = 130;

void print_devices()
{
    const std::vector<voile::engine::DeviceInfo> devices = voile::engine::list_devices();
    for (size_t i = 0; i < devices.size(); ++i)
        std::printf("%zu: %s (%s)%s%s\n", i, devices[i].name.c_str(), devices[i].driver.c_str(),
                    devices[i].unusable.empty() ? "" : ", cannot be used: ", devices[i].unusable.c_str());
    if (devices.empty())
        throw voile::engine::StartupError("no Vulkan device on this system");
}

// Before a long run: files that are written at its end must be writable.
void check_targets(const Options& options)
{
    if (options.out)
        voile::engine::take(make_picture_folder(*options.out));
    if (options.stats)
        (void)voile::engine::take(voile::engine::AtomicFile::create(*options.stats));
    for (const ExportTarget& target : options.exports)
        (void)voile::engine::take(voile::engine::AtomicFile::create(target.path));
}

// The engine knows what is wrong, and this knows the words that were likely meant.
void check_device(const std::string& wanted)
{
    if (wanted.find_first_not_of("0123456789") == std::string::npos)
        return;
    std::vector<std::string> words;
    for (const voile::engine::DeviceInfo& device : voile::engine::list_devices())
    {
        if (device.name.find(wanted) != std::string::npos)
            return;
        std::istringstream name(device.name);
        std::copy(std::istream_iterator<std::string>(name), {}, std::back_inserter(words));
        words.push_back(device.name);
    }
    throw voile::engine::StartupError("--device: no device is called " + in_quotes(wanted) + suggestion(wanted, words) +
                                      " (--list-devices shows them)");
}

voile::engine::AppOptions app_options(const Options& options, const SceneFile& scene)
{
    voile::engine::AppOptions result;
    result.title = "voile: " + scene.name;
    result.extent = {options.width, options.height};
    result.headless = options.headless;
    result.fixed_extent = options.out || options.video; // files hold pictures of one size
    result.device.device = options.device.value_or("");
    result.device.validation = options.validate;
    result.time_step = 1 / scene.step.rate;
    result.timestamps = true;
    return result;
}

// One frame, captured if that was asked for. False when the window was closed.
bool run_frame(voile::engine::App& app, voile::engine::Capture* capture)
{
    if (capture != nullptr)
        capture->begin();
    const bool open = app.frame();
    if (capture != nullptr)
    {
        app.finish();
        std::printf("capture: %s\n", capture->end().c_str());
    }
    return open;
}

// The files that grow with every frame.
struct Outputs
{
    FrameOutputs pictures;
    AnimationExports animations;
};

// What a run measures.
struct Measured
{
    RunStatistics statistics;
    SofteningNotes softening;
    double seconds = 0;     // that were simulated
    bool simulated = false; // in the last frame
};

void connect(voile::engine::App& app, LoadedScene& scene, Outputs& outputs, Measured& measured, Controls& controls,
             Panel& panel)
{
    const Options& options = scene.options;
    app.draws = [&](const voile::engine::FrameInfo& frame)
    { return options.stats || options.capture == frame.index || outputs.pictures.wants_picture(frame); };
    app.after_render = [&](VkCommandBuffer cmd, const voile::engine::FrameInfo& frame)
    {
        measured.simulated = frame.simulates;
        if (frame.simulates)
        {
            outputs.pictures.record(cmd, frame);
            outputs.animations.record(cmd, frame);
        }
        controls.record(cmd, frame);
    };
    app.completed = [&](const voile::engine::FrameInfo& frame)
    {
        controls.completed(frame);
        panel.completed(frame);
        if (!frame.simulates)
            return;
        measured.seconds = frame.time + static_cast<double>(frame.time_step);
        measured.statistics.completed(scene.stage, frame);
        voile::engine::take(outputs.pictures.write(frame));
        voile::engine::take(outputs.animations.write(frame));
    };
    app.on_input = [&](voile::engine::Input input, float seconds)
    {
        panel.update(input, seconds);
        controls.handle(input, seconds);
    };
    app.draw_overlay = [&](VkCommandBuffer cmd, const voile::engine::FrameInfo& frame) { panel.record(cmd, frame); };
    controls.restarted = [&] { measured = {}; };
}

void run_frames(voile::engine::App& app, LoadedScene& scene, Outputs& outputs, Controls& controls, Measured& measured,
                voile::engine::Capture* capture, const voile::engine::EarlyFinish& early)
{
    const Options& options = scene.options;
    const bool endless = app.has_window() && !options.frames;
    const uint64_t frames = endless ? UINT64_MAX : voile::engine::take(headless_frames(options));
    std::optional<Progress> progress;
    if (!app.has_window())
        progress.emplace(static_cast<uint32_t>(frames));
    uint64_t captured = UINT64_MAX; // the frame that --capture named is captured once
    while (app.frame_count() < frames)
    {
        const uint64_t before = app.frame_count();
        const bool last = early.requested() || before + 1 == frames;
        if (last && !app.has_window())
            outputs.pictures.announce_last();
        const bool due = options.capture == before && captured != before;
        captured = due ? before : captured;
        measured.simulated = false;
        if (!run_frame(app, due || controls.take_capture() ? capture : nullptr))
            break;
        if (measured.simulated)
        {
            measured.softening.check(scene.stage, app.time_step());
            measured.statistics.recorded(app.record_milliseconds());
            if (progress)
                progress->update(static_cast<uint32_t>(app.frame_count()));
        }
        if (last && early.requested())
            break;
    }
    app.finish();
    if (progress)
        progress->finish();
}

void export_states(const Options& options, std::vector<Surface> surfaces, size_t cloths, Outcome& outcome)
{
    if (!options.export_colliders)
        surfaces.resize(cloths);
    for (const ExportTarget& target : options.exports)
    {
        if (is_animation(target.format))
            continue;
        const auto exported = export_surfaces(target.path, surfaces);
        if (!exported)
            outcome.add(exported.error(), "");
        else
            for (const auto& path : exported.value())
                outcome.add({}, written_name(path));
    }
}

unsigned long long number(std::optional<uint64_t> count)
{
    return count.value_or(0);
}

void print_intersections(const PairCounts& pairs)
{
    if (pairs.cloth)
        std::printf("intersections: %llu pairs of cloth, %llu of cloth and collider, %llu of them uncertain\n",
                    number(pairs.cloth), number(pairs.collider), number(pairs.uncertain));
}

void add_verification(const Verification& verification, const PairCounts& pairs, Statistics& statistics)
{
    StatisticsSummary& summary = statistics.summary;
    summary.verified = true;
    summary.self_intersections = verification.self_intersections;
    summary.last.penetrating_vertices = verification.penetrating_vertices;
    summary.last.deepest_penetration = verification.deepest_penetration;
    summary.last.intersections = pairs;
    std::printf("verified: %llu penetrating vertices, deepest %.3g mm, %llu self-intersections\n",
                static_cast<unsigned long long>(verification.penetrating_vertices),
                1000 * verification.deepest_penetration,
                static_cast<unsigned long long>(verification.self_intersections));
}

int exit_code(voile::engine::App& app, const Statistics& statistics)
{
    const uint32_t messages = app.device().validation().count();
    if (messages > 0)
        std::fprintf(stderr, "viewer: %u validation messages\n", messages);
    const uint64_t broken = statistics.summary.last.nan_vertices.value_or(0);
    if (broken > 0)
        std::fprintf(stderr, "viewer: %llu vertices are not finite\n", static_cast<unsigned long long>(broken));
    return messages > 0 || broken > 0 ? k_invalid : k_done;
}

int run_scene(const Options& options)
{
    LoadedScene scene = voile::engine::take(load(options));
    std::vector<std::string> solids;
    std::ranges::transform(scene.solids, std::back_inserter(solids), &Solid::name);
    voile::engine::take(check_outputs(options, scene.file, solids));
    check_targets(options);
    if (options.device)
        check_device(*options.device);
    std::optional<voile::engine::Capture> capture; // before the instance
    if (options.capture || options.capture_key)
    {
        const std::string name = options.capture ? "voile_frame" + std::to_string(*options.capture) : "voile";
        capture.emplace((options.out.value_or(".") / name).string());
    }

    WatchedShaders shaders(scene.options);
    voile::engine::App app(app_options(options, scene.file));
    if (!app.has_window() && !options.headless)
        std::fprintf(stderr, "viewer: no display, running headless\n");
    voile::engine::take(set_up(app, scene));
    app.renderer().modes.full_strain = 0.01f * static_cast<float>(options.debug.strain.value_or(0));
    // An animation rules out that another scene takes the place of this one.
    const ExportScene animated(scene.stage, scene.solids,
                               is_animated(options) ? download_state(app.device(), scene.stage)
                                                    : std::vector<FinalCloth>{},
                               2 * app.scene().focus_radius, options);
    Outputs outputs{voile::engine::take(FrameOutputs::create(app, static_cast<double>(scene.file.step.rate), options)),
                    voile::engine::take(AnimationExports::create(app, scene.stage, animated, scene.file, options))};
    Measured measured;
    Controls controls(app, scene);
    Panel panel(app, scene, controls, shaders);
    const voile::engine::IdleGuard idle(app.device());
    connect(app, scene, outputs, measured, controls, panel);
    shaders.connect(app, controls);
    const voile::engine::EarlyFinish early;
    run_frames(app, scene, outputs, controls, measured, capture ? &*capture : nullptr, early);

    // What cannot be written keeps nothing else from being so.
    Outcome outcome;
    outputs.pictures.finish(outcome);
    outputs.animations.finish(outcome);
    const std::vector<FinalCloth> state = download_state(app.device(), scene.stage);
    const ExportScene last(scene.stage, scene.solids, {}, 2 * app.scene().focus_radius, options);
    export_states(options, last.surfaces(state, measured.seconds), state.size(), outcome);
    Statistics statistics =
        measured.statistics.result(scene.stage, scene.file, app.device().info(), state, app.time_step());
    if (options.verify)
        add_verification(voile::engine::take(verify(scene.stage, scene.solids, state)),
                         pair_counts(count_intersections(app.device(), scene.stage)), statistics);
    print_intersections(statistics.summary.last.intersections);
    if (options.stats)
        outcome.add(save_statistics(*options.stats, statistics), written_name(*options.stats));
    for (const std::string& line : outcome.written)
        std::printf("wrote %s\n", line.c_str());
    if (outcome.failure)
        throw voile::engine::StartupError(outcome.failure->message);
    const int code = exit_code(app, statistics);
    return early.requested() ? k_interrupted : code;
}

int run(int count, char** arguments)
{
    const Options options = voile::engine::take(parse_options(count, arguments));
    if (!options.message.empty())
    {
        std::fputs(options.message.c_str(), stdout);
        return k_done;
    }
    if (options.list_devices)
    {
        print_devices();
        return k_done;
    }
    return run_scene(options);
}

} // namespace

int main(int count, char** arguments)
{
    constexpr size_t k_longest_message = 2000; // bytes
    try
    {
        voile::engine::end_cleanly_on_signals("viewer");
        const int code = run(count, arguments);
        if (code != k_interrupted)
            return code;
        (void)std::fflush(nullptr);
        voile::engine::end_by_interrupt();
    }
    catch (const std::bad_alloc&)
    {
        std::fprintf(stderr, "viewer: out of memory\n");
    }
    catch (const std::exception& error) // voile::engine::StartupError with the reason in one line
    {
        std::fprintf(stderr, "viewer: %s\n", voile::gpu::printable(error.what(), k_longest_message).c_str());
    }
    return k_failed;
}
