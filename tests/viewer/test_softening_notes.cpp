// Notes on softened cloths, while a run goes on.
#include "samples/viewer/softening_notes.hpp"

#include "support/test_folder.hpp"
#include "voile/fabrics.hpp"

#include <doctest/doctest.h>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <string>

namespace
{

// What is written to standard error meanwhile.
template <typename Action>
std::string errors_of(Action action)
{
    const TestFolder folder;
    const std::string file = (folder / "errors").string();
    std::fflush(stderr);
    const int before = ::dup(STDERR_FILENO);
    const int out = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    ::dup2(out, STDERR_FILENO);
    action();
    std::fflush(stderr);
    ::dup2(before, STDERR_FILENO);
    ::close(before);
    ::close(out);
    return folder.read("errors");
}

} // namespace

TEST_CASE("a cloth is noted when it is first softened, and not again")
{
    voile::engine::Device device(voile::engine::DeviceOptions{});
    voile::component::ClothWorld world(device, 1);
    viewer::Stage stage;
    stage.world = &world;
    for (const char* name : {"first", "second"})
    {
        const auto id = world.solver().add_cloth(
            voile::GridCloth{.name = name, .columns = 8, .rows = 8, .width = 1, .depth = 1, .material = voile::silk()});
        REQUIRE(id);
        stage.cloths.push_back({name, id.value(), {}, 1});
    }
    constexpr float k_frame = 1.f / 60;
    viewer::SofteningNotes notes;
    world.step.max_substeps = world.solver().stable_substeps(k_frame);
    CHECK(errors_of([&] { notes.check(stage, k_frame); }).empty());

    // What a run may do: the second becomes stiffer than the step's substeps bear.
    voile::Fabric stiff = voile::silk();
    stiff.stretch_stiffness = {30000, 30000};
    REQUIRE(world.solver().set_material(stage.cloths[1].id, stiff));
    const std::string said = errors_of([&] { notes.check(stage, k_frame); });
    CHECK(said.starts_with("viewer: note: cloth \"second\" needs "));
    CHECK(said.find(" substeps a frame and gets " + std::to_string(world.step.max_substeps) + ": it has ") !=
          std::string::npos);
    CHECK(std::count(said.begin(), said.end(), '\n') == 1);
    CHECK(errors_of([&] { notes.check(stage, k_frame); }).empty());

    REQUIRE(world.solver().set_material(stage.cloths[0].id, stiff));
    CHECK(errors_of([&] { notes.check(stage, k_frame); }).starts_with("viewer: note: cloth \"first\" needs "));
    // Fewer substeps than are set soften, too.
    world.step.substeps = 1;
    viewer::SofteningNotes fewer;
    CHECK(errors_of([&] { fewer.check(stage, k_frame); }).find("gets 1: it has ") != std::string::npos);
    // What is left of it is never rounded up to all, nor written as "1e+02 %".
    world.step.substeps = world.solver().stable_substeps(1, UINT32_MAX) - 1;
    viewer::SofteningNotes nearly;
    CHECK(errors_of([&] { nearly.check(stage, 1); }).find(": it has 99.9 % of its stiffness") != std::string::npos);
}
