// App: owns device, scene, renderer and, with a display, a window, and runs the frame loop.
#pragma once

#include "voile/engine/app/window.hpp"
#include "voile/engine/gpu/frames.hpp"
#include "voile/engine/gpu/upload.hpp"
#include "voile/engine/render/renderer.hpp"

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace voile::engine
{

struct AppOptions
{
    std::string title = "voile";
    VkExtent2D extent{1280, 720};
    bool headless = false;     // no window, even with a display
    bool fixed_extent = false; // pictures keep their extent when the window is resized, and are scaled into it
    DeviceOptions device{};
    uint32_t slots = 2;         // frames in flight
    float time_step = 1.f / 60; // s per frame
    bool timestamps = false;    // time the passes on the GPU
};

class App
{
public:
    explicit App(const AppOptions& options); // StartupError
    ~App();
    App(const App&) = delete;
    App& operator=(const App&) = delete;

    [[nodiscard]] Device& device() { return device_; }
    [[nodiscard]] Scene& scene() { return scene_; }
    [[nodiscard]] Renderer& renderer() { return renderer_; }
    [[nodiscard]] bool has_window() const { return window_ != nullptr; }
    [[nodiscard]] Window* window() { return window_.get(); } // null without one
    [[nodiscard]] uint32_t slots() const { return frames_.slots(); }
    [[nodiscard]] gpu::Timestamps* timestamps() { return timestamps_ ? &*timestamps_ : nullptr; }

    // Collects uploads of components under construction. Recorded at the start of the next frame.
    [[nodiscard]] UploadBatch& uploads();

    // Called at the start of frame(), while nothing is recorded.
    std::function<void()> before_frame;
    // Without a window: whether a frame is drawn. Default: every frame is. The others only simulate, which saves most
    // of the time of a software device.
    std::function<bool(const FrameInfo&)> draws;
    // Called after the scene has been drawn, outside rendering: for copies out of the frame.
    std::function<void(VkCommandBuffer, const FrameInfo&)> after_render;
    // In a window: draws over the finished picture, after `after_render`. The renderer's picture must end in
    // TRANSFER_SRC_OPTIMAL, as Renderer::record leaves it.
    std::function<void(VkCommandBuffer, const FrameInfo&)> draw_overlay;
    // In a window: called with what the user has done, before a frame begins. Default: steers the camera
    // (camera_control.hpp). `seconds`: since the last call.
    std::function<void(const Input&, float seconds)> on_input;
    // Called when the GPU has completed a frame, before its slot is used again.
    std::function<void(const FrameInfo&)> completed;

    // Records and submits one frame: uploads, compute, shadow and scene passes, all in one command buffer. Returns
    // false when the user has closed the window; that frame is not run. A minimized window waits without simulating. In
    // a window a frame begins no sooner than one time step after the last one, so that fast displays show real time.
    bool frame();

    // Waits for all frames in flight and calls `completed` for each, in their order.
    void finish();

    // Whether frames simulate. Those that do not draw the state as it is; their index and time are those of the next
    // frame that does.
    void set_simulating(bool simulating) { simulating_ = simulating; }
    // s per frame, from the next frame on. Frames in a window still follow each other as AppOptions says, so a shorter
    // step is slow motion.
    void set_time_step(float time_step);
    // Starts again at frame 0 and time 0 with an empty scene. Waits for the frames in flight.
    void restart();

    // Runs until the window is closed, or, headless, for `headless_frames`.
    void run(uint64_t headless_frames);

    [[nodiscard]] float time_step() const { return time_step_; }                      // s
    [[nodiscard]] uint64_t frame_count() const { return next_index_; }                // simulated frames so far
    [[nodiscard]] double time() const;                                                // s, simulated so far
    [[nodiscard]] double record_milliseconds() const { return record_milliseconds_; } // host time of the last frame

private:
    void complete(uint32_t slot);
    void record(const FrameRing::Frame& frame, const FrameInfo& info, const Window::Target* target);
    void follow_user();
    void keep_pace();

    std::unique_ptr<Window> window_; // before the device: the instance needs its extensions
    Device device_;
    FrameRing frames_;
    std::optional<gpu::Timestamps> timestamps_;
    Renderer renderer_;
    std::unique_ptr<UploadBatch> uploads_;
    std::vector<std::unique_ptr<UploadBatch>> uploads_in_flight_; // one per slot
    std::vector<std::optional<FrameInfo>> in_flight_;             // one per slot
    Scene scene_;                                                 // last: components are destroyed before what they
                                                                  // borrow
    float time_step_;
    float frame_time_; // s, between frames in a window
    bool fixed_extent_;
    bool simulating_ = true;
    uint64_t next_index_ = 0;
    uint64_t step_index_ = 0; // the first frame of this time step, and its time
    double step_time_ = 0;
    double record_milliseconds_ = 0;
    std::chrono::steady_clock::time_point next_frame_; // when the next frame is due, in a window
    std::chrono::steady_clock::time_point last_input_;
};

} // namespace voile::engine
