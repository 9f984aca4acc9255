// A host that loads Vulkan with volk, whose variables have the names of Vulkan's functions.
#include <volk.h>

#include "falling_sheet.hpp"

int main()
{
    if (volkInitialize() != VK_SUCCESS)
        return 1;
    foreign::Engine engine({.get_instance_proc_addr = vkGetInstanceProcAddr});
    volkLoadInstance(engine.instance());
    volkLoadDevice(engine.device());
    const voile::CommandReuse reuse{.queue_family = engine.queue_family(foreign::Lane::main),
                                    .steps_in_flight = foreign::Engine::k_slots};
    return let_a_sheet_fall(engine, handles_of(engine), {.command_reuse = reuse});
}
