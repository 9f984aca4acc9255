// Panel: built without Dear ImGui.
#include "samples/viewer/panel.hpp"

namespace viewer
{

struct Panel::State
{
    Controls& controls;
    bool told = false;
};

Panel::Panel(voile::engine::App&, LoadedScene&, Controls& controls, const WatchedShaders&) : state_(new State{controls})
{
}
Panel::~Panel() = default;

// The help goes to standard output.
void Panel::update(voile::engine::Input&, float)
{
    if (state_->controls.show_help && !state_->told)
        for (const ControlHelp& line : control_help())
            std::printf("%-32s %s\n", line.keys, line.action);
    state_->told = state_->controls.show_help;
}

void Panel::record(VkCommandBuffer, const voile::engine::FrameInfo&) {}
void Panel::completed(const voile::engine::FrameInfo&) {}

} // namespace viewer
