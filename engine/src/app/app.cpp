// App: the frame loop. One frame, from events to submission, is App::frame and App::record.
#include "voile/engine/app/app.hpp"

#include <chrono>
#include <cmath>
#include <thread>

namespace voile::engine
{

namespace
{

DeviceOptions device_options(const AppOptions& options, bool window)
{
    DeviceOptions result = options.device;
    if (window)
    {
        result.instance_extensions = window_instance_extensions();
        result.swapchain = true;
    }
    return result;
}

std::unique_ptr<Window> open_window(const AppOptions& options)
{
    if (options.headless || !display_available())
        return nullptr;
    return std::make_unique<Window>(options.title, options.extent);
}

} // namespace

App::App(const AppOptions& options)
    : window_(open_window(options)), device_(device_options(options, window_ != nullptr)),
      frames_(device_, options.slots), renderer_(device_, {.extent = options.extent, .slots = options.slots}),
      uploads_in_flight_(options.slots), in_flight_(options.slots), time_step_(options.time_step),
      fixed_extent_(options.fixed_extent)
{
    constexpr uint32_t k_most_passes = 4096; // substeps times passes; beyond it, passes go untimed
    if (options.timestamps)
        timestamps_ =
            take(gpu::Timestamps::create(device_.context(), device_.queue_family(), options.slots, k_most_passes));
    if (window_)
        window_->attach(device_, options.slots);
}

App::~App()
{
    (void)device_.context().fn.vkDeviceWaitIdle(device_.context().device()); // a lost device has no work to wait for
    if (window_)
        window_->detach();
}

UploadBatch& App::uploads()
{
    if (!uploads_)
        uploads_ = std::make_unique<UploadBatch>(device_.context());
    return *uploads_;
}

void App::complete(uint32_t slot)
{
    uploads_in_flight_[slot].reset();
    if (!in_flight_[slot])
        return;
    const FrameInfo info = *in_flight_[slot];
    in_flight_[slot].reset();
    if (completed)
        completed(info);
}

bool App::frame()
{
    if (window_)
    {
        if (!window_->poll())
            return false;
        if (window_->minimized())
            return true;
        steer_camera();
        keep_pace();
    }
    const FrameRing::Frame frame = frames_.begin();
    complete(frame.slot);
    std::optional<Window::Target> target;
    if (window_)
    {
        const VkExtent2D wanted = window_->framebuffer_extent();
        if (!fixed_extent_ && (wanted.width != renderer_.extent().width || wanted.height != renderer_.extent().height))
        {
            device_.wait_idle();
            renderer_.resize(wanted);
        }
        target = window_->acquire(frame.slot);
    }

    FrameInfo info;
    info.index = next_index_++;
    info.time = static_cast<double>(info.index) * static_cast<double>(time_step_);
    info.time_step = time_step_;
    info.slot = frame.slot;
    info.timestamps = timestamps();
    record(frame, info, target ? &*target : nullptr);
    frames_.submit(frame, target ? target->acquired : VK_NULL_HANDLE, target ? target->rendered : VK_NULL_HANDLE);
    in_flight_[frame.slot] = info;
    if (target)
        window_->present(*target);
    return true;
}

void App::record(const FrameRing::Frame& frame, const FrameInfo& info, const Window::Target* target)
{
    const auto start = std::chrono::steady_clock::now();
    scene_.update(info);
    if (info.timestamps != nullptr)
        info.timestamps->begin_frame(frame.cmd, frame.slot);
    {
        const gpu::LabelScope scope(device_.context(), frame.cmd, "frame", info.timestamps);
        if (uploads_)
        {
            uploads_->record(frame.cmd);
            uploads_in_flight_[frame.slot] = std::move(uploads_);
        }
        scene_.record_compute(frame.cmd, info);
        if (window_ || !draws || draws(info))
            renderer_.record(frame.cmd, scene_, info);
        if (after_render)
            after_render(frame.cmd, info);
        if (target != nullptr)
            window_->record_blit(frame.cmd, renderer_.color(), *target);
    }
    const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start;
    record_milliseconds_ = elapsed.count();
}

void App::finish()
{
    for (uint32_t i = 0; i < frames_.slots(); ++i)
    {
        const auto slot = static_cast<uint32_t>((next_index_ + i) % frames_.slots()); // the oldest first
        frames_.wait(slot);
        complete(slot);
    }
}

void App::run(uint64_t headless_frames)
{
    for (uint64_t i = 0; has_window() || i < headless_frames; ++i)
        if (!frame())
            break;
    finish();
}

void App::keep_pace()
{
    using Clock = std::chrono::steady_clock;
    std::this_thread::sleep_until(next_frame_);
    // Counts from the due time, not from now, so that oversleeping does not add up. A late frame restarts the count.
    const Clock::time_point now = Clock::now();
    const auto step = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<float>(time_step_));
    next_frame_ = next_frame_ + step < now ? now + step : next_frame_ + step;
}

// Dragging turns the camera around its target. The wheel moves it closer.
void App::steer_camera()
{
    const Window::Input input = window_->take_input();
    if (input.drag_x == 0 && input.drag_y == 0 && input.wheel == 0)
        return;
    constexpr float k_radians_per_pixel = 0.005f;
    constexpr float k_steepest = 1.5f; // radians above or below the target
    Camera& camera = scene_.camera;
    const glm::vec3 offset = camera.position - camera.target;
    const float distance = glm::length(offset) * std::pow(0.9f, static_cast<float>(input.wheel));
    const float azimuth = std::atan2(offset.x, offset.z) - static_cast<float>(input.drag_x) * k_radians_per_pixel;
    const float elevation = glm::clamp(std::asin(glm::clamp(offset.y / glm::length(offset), -1.f, 1.f)) +
                                           static_cast<float>(input.drag_y) * k_radians_per_pixel,
                                       -k_steepest, k_steepest);
    camera.position = camera.target + distance * glm::vec3(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                                                           std::cos(elevation) * std::cos(azimuth));
}

} // namespace voile::engine
