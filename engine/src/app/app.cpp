// App: the frame loop. One frame, from events to submission, is App::frame and App::record.
#include "voile/engine/app/app.hpp"

#include "voile/engine/app/camera_control.hpp"

#include <chrono>
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
      frame_time_(options.time_step), fixed_extent_(options.fixed_extent)
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
    if (before_frame)
        before_frame();
    if (window_)
    {
        if (!window_->poll())
            return false;
        if (window_->minimized())
            return true;
        follow_user();
        if (!window_->open())
            return false;
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
    info.index = next_index_;
    info.time = time();
    info.simulates = simulating_;
    next_index_ += simulating_ ? 1 : 0;
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
        if (window_ && draw_overlay)
            draw_overlay(frame.cmd, info);
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
    const auto step = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<float>(frame_time_));
    next_frame_ = next_frame_ + step < now ? now + step : next_frame_ + step;
}

void App::follow_user()
{
    using Clock = std::chrono::steady_clock;
    const Input input = window_->take_input();
    const Clock::time_point now = Clock::now();
    const float seconds =
        last_input_ == Clock::time_point{} ? 0 : std::chrono::duration<float>(now - last_input_).count();
    last_input_ = now;
    if (on_input)
        on_input(input, seconds);
    else
        steer(scene_.camera, input, seconds, scene_.focus_radius);
}

double App::time() const
{
    return step_time_ + static_cast<double>(next_index_ - step_index_) * static_cast<double>(time_step_);
}

void App::set_time_step(float time_step)
{
    step_time_ = time();
    step_index_ = next_index_;
    time_step_ = time_step;
}

void App::restart()
{
    finish();
    scene_.clear();
    uploads_.reset();
    next_index_ = step_index_ = 0;
    step_time_ = 0;
}

} // namespace voile::engine
