// What a model makes of cloth meshes, to the bit: the same springs in the same order as ever. The hashes are of IEEE
// arithmetic without contraction; compilers for other machines than x86-64 contract by default.
#include "geometry/parallel.hpp"
#include "model/active_lists.hpp"
#include "support/backward_jobs.hpp"
#include "support/odd_meshes.hpp"
#include "support/record_hash.hpp"

#include "voile/fabrics.hpp"

#include <doctest/doctest.h>

#include <array>
#include <functional>
#include <string>
#include <thread>

namespace
{

using tests::RecordHash;

void add_report(RecordHash& hash, const voile::MeshReport& report)
{
    for (const uint32_t count :
         {report.components, report.boundary_edges, report.non_manifold_edges, report.isolated_vertices,
          report.degenerate_triangles, report.coincident_vertices, report.softened_edges})
        hash.add(count);
    hash.add(report.shortest_edge);
}

void add_lists(RecordHash& hash, const voile::MeshLists& lists)
{
    hash.add_all(lists.vertices);
    hash.add_all(lists.springs);
    hash.add_all(lists.corners);
    hash.add_all(lists.membrane);
}

uint64_t hash_topology(const voile::MeshTopology& mesh)
{
    RecordHash hash;
    add_lists(hash, mesh.lists);
    for (const voile::MembraneTriangle& t : mesh.membrane)
    {
        hash.add(t.corner);
        hash.add(t.position);
        hash.add(t.area);
        hash.add(t.weight);
        std::array<uint32_t, 3> edges{t.edge[0], t.edge[1], t.edge[2]};
        hash.add(edges);
    }
    hash.add_all(mesh.areas);
    add_report(hash, mesh.report);
    for (const voile::MeshTopology::Bounds& bounds : {mesh.fabric, mesh.uniform})
        for (const double bound : {bounds.edge, bounds.opposite, bounds.bending})
            hash.add(bound);
    hash.add(mesh.mean_area);
    return hash.value();
}

// Of the arrays of all cloths, one after the other, as they are uploaded.
template <typename T>
void add_joined(RecordHash& hash, const voile::Model& model, std::vector<T> voile::ClothModel::*member)
{
    std::vector<T> all;
    for (const auto [index, cloth] : model.cloths)
        all.insert(all.end(), (cloth.*member).begin(), (cloth.*member).end());
    hash.add_all(all);
}

// The lists of all meshes, either as the cloths have them or interleaved.
voile::MeshLists joined_lists(const voile::Model& model, bool interleaved)
{
    std::vector<voile::shared::MeshVertex> vertices;
    std::vector<voile::shared::MeshSpring> springs;
    std::vector<voile::shared::MeshCorner> corners;
    std::vector<voile::shared::MembraneCorner> membrane;
    const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    for (const auto [index, cloth] : model.cloths)
    {
        if (!cloth.mesh)
            continue;
        const voile::MeshLists& lists = interleaved ? *cloth.lists : cloth.mesh->lists;
        for (voile::shared::MeshVertex vertex : lists.vertices)
        {
            vertex.first_spring += static_cast<uint32_t>(springs.size());
            vertex.first_corner += static_cast<uint32_t>(corners.size());
            vertices.push_back(vertex);
        }
        append(springs, lists.springs);
        append(corners, lists.corners);
        append(membrane, lists.membrane);
    }
    return {std::move(vertices), std::move(springs), std::move(corners), std::move(membrane)};
}

uint64_t hash_model(voile::Model model)
{
    for (auto [index, cloth] : model.cloths)
        cloth.uploaded = true; // patches are those of uploaded cloths
    RecordHash hash;
    for (const auto [index, cloth] : model.cloths)
    {
        voile::shared::ClothRecord record = cloth.record;
        if (!cloth.mesh) // from sines, whose last bit is the C library's
            record.omega_squared = record.flat_omega_squared = record.decay = 0;
        hash.add(record);
    }
    add_joined(hash, model, &voile::ClothModel::start);
    add_joined(hash, model, &voile::ClothModel::positions);
    add_joined(hash, model, &voile::ClothModel::residuals);
    add_joined(hash, model, &voile::ClothModel::velocities);
    voile::ActiveLists active;
    voile::list_patches(model, voile::assigned_level, 32, active);
    hash.add_all(active.patches);
    hash.add(active.batches[0].patches.count);
    add_lists(hash, joined_lists(model, false));
    add_lists(hash, joined_lists(model, true));
    return hash.value();
}

voile::ClothMaterial material(bool fabric, bool isometric)
{
    if (!fabric)
    {
        voile::Material result;
        result.bending_stiffness = isometric ? 1e-3f : 0;
        return result;
    }
    voile::Fabric result;
    result.bending_model = isometric ? voile::BendingModel::isometric : voile::BendingModel::springs;
    return result;
}

struct Expected
{
    std::string name;
    std::function<tests::ClothMesh()> make;
    std::array<uint64_t, 4> topology; // a Fabric with springs across edges, an isometric one, and both with a Material
};

const Expected k_expected[] = {
    {"a rough sheet",
     [] { return tests::rough_sheet(13, 9); },
     {0xdb6b294d31a0038d, 0x4efe612ec3c4b0d8, 0x15e6cc9ce7723e20, 0xb3e1a343aa2655a1}},
    {"a shuffled sheet",
     tests::shuffled_sheet,
     {0x094dc9e759a4b3d7, 0x55588607fdac27c3, 0x563646df0f08b5f5, 0x8ce6f836be10082d}},
    {"an octahedron",
     tests::octahedron,
     {0x0369709eaa5a2ab5, 0x4e5d0b56687116d8, 0xfb2fcb19c6f46f35, 0x0de44f3a92aba9e8}},
    {"T junctions",
     tests::t_junctions,
     {0x8d6477907973aac1, 0x91a9becae642107b, 0x2588ec403edefba9, 0xbbfbb3172bcf4946}},
    {"doubled triangles",
     tests::doubled_triangles,
     {0x1932da6a03f6cdd8, 0x2cf2325094cb9bfe, 0xa6b3bb746b331586, 0xbafd34e66e9e685c}},
    {"an open seam",
     tests::open_seam,
     {0x2357bead0a70c5ae, 0x60b193f156731ad9, 0x1965e54d7661a606, 0x2798983849f0c9c9}},
    {"a fan", tests::fan, {0xc3008b61b58785ff, 0x5ef9412ee77b6bd9, 0xe8128cdee5a4a6bc, 0xc0554f0962b0da32}},
    {"loose ends", tests::loose_ends, {0xf1f4eef2a5594eec, 0x4541bb63b789a7c5, 0x0985d3cd325d914f, 0x248176f143c5fd0a}},
    {"a loose sliver",
     [] { return tests::slivers(tests::Sliver::loose); },
     {0x44be7a3c028b1862, 0xf3aaf901d681a189, 0x2d49e0c6e606797c, 0x2a8105a58ea8f0ef}},
    {"a sliver inside",
     [] { return tests::slivers(tests::Sliver::inside); },
     {0x45a51943b1126bb9, 0x5b3b6a7640407dc5, 0x32f34516de0b3e72, 0xfdc2219d63bedfd6}},
    {"a needle",
     [] { return tests::slivers(tests::Sliver::needle); },
     {0xbc0a93ae84d3bd59, 0xe14b3c0014ff707d, 0x6c84e5e270fc59ec, 0x486d1337310a2975}},
};

} // namespace

TEST_CASE("odd meshes have the springs, corners and membranes that they had, to the bit")
{
    for (const Expected& expected : k_expected)
    {
        CAPTURE(expected.name);
        const tests::ClothMesh mesh = expected.make();
        for (size_t i = 0; i < expected.topology.size(); ++i)
        {
            CAPTURE(i);
            voile::Model model;
            voile::MeshCloth cloth = mesh.cloth();
            cloth.material = material(i < 2, i % 2 == 1);
            REQUIRE(model.add(cloth));
            CHECK(hash_topology(*model.cloths.at(0)->mesh) == expected.topology[i]);
        }
    }
}

TEST_CASE("what is uploaded of several cloths is what it was, to the bit")
{
    voile::Model model;
    model.limits.workgroup_size = 32;
    bool fabric = false;
    uint32_t number = 0;
    for (const Expected& expected : k_expected)
    {
        const tests::ClothMesh mesh = expected.make();
        voile::MeshCloth cloth = mesh.cloth();
        cloth.material = material(fabric = !fabric, number % 3 == 0);
        cloth.integrator = number % 4 < 2 ? voile::Integrator::rk4 : voile::Integrator::verlet;
        cloth.velocity = glm::vec3(0.5f, 0, 1);
        cloth.pins = {1, 3, 1};
        cloth.transform[3] = glm::vec4(1.3f * static_cast<float>(number), 0.1f, 1e4f, 1);
        if (number % 5 == 1)
            cloth.inverse_masses.assign(mesh.positions.size(), 700.f);
        REQUIRE(model.add(cloth));
        if (number++ % 3 == 1)
        {
            voile::GridCloth grid{.columns = 7, .rows = 40, .width = 0.5625f, .depth = 4.875f};
            grid.material = material(false, false);
            REQUIRE(model.add(grid));
        }
    }
    CHECK(hash_model(model) == 0x7c6050128470895f);
}

namespace
{

// A job system of a host: a thread for each task.
void run_on_threads(void* user, uint32_t count, voile::Jobs::Task task, void* data)
{
    *static_cast<uint32_t*>(user) += count;
    std::vector<std::jthread> threads;
    for (uint32_t i = 0; i < count; ++i)
        threads.emplace_back(task, data, i);
}

// Of a mesh with each kind of material.
std::array<uint64_t, 2> hash_added(const tests::ClothMesh& mesh)
{
    voile::Model model;
    model.limits.workgroup_size = 32;
    voile::MeshCloth cloth = mesh.cloth();
    RecordHash topologies;
    for (const bool fabric : {true, false})
    {
        cloth.material = material(fabric, true);
        REQUIRE(model.add(cloth));
        topologies.add(hash_topology(*model.cloths.at(fabric ? 0 : 1)->mesh));
    }
    return {topologies.value(), hash_model(std::move(model))};
}

} // namespace

TEST_CASE("large meshes have the same springs, corners and membranes for any number of threads and any jobs")
{
    tests::ClothMesh sheet = tests::rough_sheet(170, 120); // several pieces of work, and ranges for seven threads
    tests::add_sliver(sheet, 170, 120, tests::Sliver::inside, 1e-5f);
    tests::ClothMesh shuffled = sheet;
    tests::shuffle(shuffled);
    for (const tests::ClothMesh& mesh : {sheet, shuffled})
    {
        uint32_t tasks = 0;
        const auto hash = [&](auto run, uint32_t workers)
        {
            tasks = 0;
            const voile::JobScope scope({.run = run, .user = &tasks, .workers = workers});
            return hash_added(mesh);
        };
        const std::array<uint64_t, 2> expected = hash(run_on_threads, 1);
        CHECK(tasks == 0);
        for (const uint32_t workers : {2u, 7u})
            for (const auto run : {run_on_threads, tests::run_backwards})
            {
                CAPTURE(workers);
                CHECK(hash(run, workers) == expected);
                CHECK(tasks > 0);
            }
        CHECK(hash_added(mesh) == expected); // by the module's own threads
    }
}
