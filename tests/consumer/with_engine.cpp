// A program with engine, component and module: it makes a device and a cloth in a scene, and draws nothing.
#include <voile/cloth_component.hpp>

#include <cstdio>

int main()
try
{
    const voile::engine::Device device({});
    voile::component::ClothWorld world(device, 2);
    voile::engine::UploadBatch uploads(device.context());
    const voile::component::Sheet sheet(world, uploads, voile::GridCloth{},
                                        voile::component::fabric_surface({1, 0, 0}, {0, 0, 1}, 1));
    std::printf("%u vertices on %s\n", world.solver().vertex_count(), device.info().name.c_str());
    return 0;
}
catch (const voile::engine::StartupError& error)
{
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
