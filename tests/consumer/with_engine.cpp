// A program with engine, component and module: it makes a device and a cloth in a scene, and draws nothing.
#include <component/cloth_component.hpp>

#include <cstdio>

int main()
try
{
    const engine::Device device({});
    cloth::component::ClothWorld world(device, 2);
    engine::UploadBatch uploads(device.context());
    const cloth::component::Sheet sheet(world, uploads, cloth::Grid{},
                                        cloth::component::fabric_surface({1, 0, 0}, {0, 0, 1}, 1));
    std::printf("%u vertices on %s\n", world.solver().vertex_count(), device.info().name.c_str());
    return 0;
}
catch (const engine::StartupError& error)
{
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
