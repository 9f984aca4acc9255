// Cooked meshes: equal to the mesh itself to the bit, shared by their instances, and refused where they are damaged.
#include "colliders/collider_model.hpp"
#include "colliders/cooked_collider.hpp"
#include "geometry/bvh_query.hpp"
#include "geometry/cooked_file.hpp"
#include "model/active_lists.hpp"
#include "model/cooked_cloth.hpp"
#include "support/backward_jobs.hpp"
#include "support/bvh_checks.hpp"
#include "support/odd_meshes.hpp"

#include "voile/engine/assets/shapes.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <doctest/doctest.h>

#include <atomic>
#include <cstring>
#include <thread>

namespace
{

using Bytes = std::vector<std::byte>;

voile::ClothMaterial isometric_fabric()
{
    voile::Fabric fabric;
    fabric.bending_model = voile::BendingModel::isometric;
    return fabric;
}

template <typename T>
T take(voile::Result<T> result)
{
    REQUIRE_MESSAGE(result, (result ? std::string() : result.error().message));
    return std::move(result.value());
}

voile::CookedCloth cooked_sheet()
{
    const tests::ClothMesh mesh = tests::rough_sheet(4, 3);
    voile::MeshCloth cloth = mesh.cloth();
    cloth.material = isometric_fabric();
    return take(voile::cook(cloth));
}

voile::CookedCollider cooked_octahedron()
{
    const tests::ClothMesh mesh = tests::octahedron();
    return take(voile::cook(voile::MeshCollider{.positions = mesh.positions, .triangles = mesh.triangles}));
}

voile::MeshCloth instance(const voile::CookedCloth& cooked, const glm::mat4& transform = glm::mat4(1))
{
    voile::MeshCloth cloth;
    cloth.transform = transform;
    cloth.material = isometric_fabric();
    cloth.cooked = cooked;
    return cloth;
}

// All that an upload reads of a cloth.
bool same(const voile::ClothModel& a, const voile::ClothModel& b)
{
    const auto bits = [](const auto& x, const auto& y)
    { return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0; };
    return std::memcmp(&a.record, &b.record, sizeof(a.record)) == 0 && bits(a.start, b.start) &&
           bits(a.residuals, b.residuals) && bits(a.positions, b.positions) && bits(a.velocities, b.velocities) &&
           bits(a.lists->vertices, b.lists->vertices) && bits(a.lists->springs, b.lists->springs) &&
           bits(a.lists->corners, b.lists->corners) && bits(a.lists->membrane, b.lists->membrane) &&
           bits(a.mesh->triangles, b.mesh->triangles) &&
           bits(a.mesh->texture_coordinates, b.mesh->texture_coordinates) && bits(a.mesh->areas, b.mesh->areas) &&
           std::memcmp(&a.mesh->report, &b.mesh->report, sizeof(a.mesh->report)) == 0;
}

// Everything that the processor does with a cloth.
void use(const voile::CookedCloth& cooked)
{
    for (const bool fabric : {true, false})
    {
        voile::Model model;
        voile::MeshCloth cloth = instance(cooked, cooked.state()->transform);
        if (!fabric)
            cloth.material = voile::Material();
        if (!model.add(cloth))
            continue;
        model.cloths.at(0)->attachments.push_back({.vertex = 0});
        (void)voile::make_tethers(*model.cloths.at(0), 0, {});
        voile::ActiveLists lists;
        voile::list_patches(model, voile::assigned_level, 32, lists);
    }
}

void use(const voile::CookedCollider& cooked)
{
    voile::Model model;
    REQUIRE(model.add(voile::GridCloth{.columns = 4, .rows = 4}));
    voile::ColliderModels colliders;
    const voile::MeshCollider collider{.transform = cooked.state()->transform, .cooked = cooked};
    if (!colliders.add(collider))
        return;
    voile::update_features(colliders, model);
    (void)voile::nearest_point(*colliders.colliders.at(0)->hierarchy, glm::dvec3(0.1), 1);
}

// Loads `bytes` with every word in turn as something that a file could hold, signed anew. What is accepted is used.
template <typename Cooked>
void try_hostile_words(const Bytes& bytes)
{
    constexpr size_t k_header = 48;
    uint32_t refused = 0;
    uint32_t accepted = 0;
    for (size_t at = k_header; at + sizeof(uint32_t) <= bytes.size(); at += sizeof(uint32_t))
        for (const uint32_t value : {0u, 1u, 7u, 0x7fc00000u, 0x80000000u, 0xa0000000u, 0xffffffffu})
        {
            Bytes changed = bytes;
            std::memcpy(changed.data() + at, &value, sizeof(value));
            voile::sign_cooked(changed);
            const auto loaded = Cooked::load(changed);
            ++(loaded ? accepted : refused);
            if (loaded)
                use(loaded.value());
        }
    CHECK(refused > accepted / 4);
    CHECK(accepted > 0);
}

template <typename Cooked>
void try_damaged(const Bytes& bytes)
{
    for (size_t length = 0; length < bytes.size(); ++length)
    {
        const auto loaded = Cooked::load(std::span(bytes).first(length));
        REQUIRE_FALSE(loaded);
        REQUIRE(loaded.error().message.starts_with("cooked data: "));
    }
    for (size_t at = 0; at < bytes.size(); ++at)
        for (const uint8_t flip : {uint8_t{1}, uint8_t{0x80}})
        {
            Bytes changed = bytes;
            changed[at] ^= std::byte{flip};
            REQUIRE_FALSE(Cooked::load(changed));
        }
    Bytes longer = bytes;
    longer.resize(longer.size() + 16);
    CHECK_FALSE(Cooked::load(longer));
}

} // namespace

TEST_CASE("a cooked cloth equals its mesh to the bit, also by way of bytes")
{
    for (const tests::ClothMesh& mesh :
         {tests::rough_sheet(13, 9), tests::shuffled_sheet(), tests::t_junctions(), tests::doubled_triangles(),
          tests::open_seam(), tests::fan(), tests::loose_ends(), tests::slivers(tests::Sliver::loose)})
        for (const bool fabric : {true, false})
        {
            voile::MeshCloth cloth = mesh.cloth();
            cloth.transform = glm::rotate(glm::mat4(1.5f), 0.7f, glm::vec3(0, 1, 0));
            cloth.transform[3] = glm::vec4(3, 1, -2, 1);
            cloth.pins = {1, 2};
            if (fabric)
                cloth.material = isometric_fabric();
            const voile::CookedCloth cooked = take(voile::cook(cloth));
            CHECK(cooked.vertices() == mesh.positions.size());
            CHECK(cooked.triangles() == mesh.triangles.size());
            const Bytes bytes = cooked.bytes();
            CHECK(bytes == take(voile::cook(cloth)).bytes());
            const voile::CookedCloth loaded = take(voile::CookedCloth::load(bytes));
            CHECK(loaded.bytes() == bytes);

            voile::Model model;
            REQUIRE(model.add(cloth));
            cloth.positions = {};
            cloth.triangles = {};
            for (const voile::CookedCloth& asset : {cooked, loaded})
            {
                voile::Model other;
                cloth.cooked = asset;
                REQUIRE(other.add(cloth));
                CHECK(same(*model.cloths.at(0), *other.cloths.at(0)));
            }
        }
}

TEST_CASE("a hundred instances of a cooked cloth share what is at rest")
{
    const voile::CookedCloth cooked = cooked_sheet();
    voile::Model model;
    for (int i = 0; i < 100; ++i)
    {
        const float at = static_cast<float>(i);
        REQUIRE(model.add(instance(
            cooked, glm::rotate(glm::translate(glm::mat4(1), glm::vec3(at, 0, 0)), 0.1f * at, glm::vec3(1, 2, 3)))));
    }
    for (const auto [index, cloth] : model.cloths)
    {
        CHECK(cloth.mesh == cooked.state()->mesh);
        CHECK(cloth.lists == model.cloths.at(0)->lists);
    }
    CHECK(model.cloths.at(7)->record.first_vertex == 7 * cooked.vertices());
    const glm::vec3 moved(model.cloths.at(9)->start[5] - model.cloths.at(9)->start[0]);
    const glm::vec3 there(model.cloths.at(0)->start[5] - model.cloths.at(0)->start[0]);
    CHECK(glm::length(moved) == doctest::Approx(glm::length(there)));
}

TEST_CASE("a cooked cloth is refused where it does not fit its description")
{
    const voile::CookedCloth cooked = cooked_sheet();
    voile::Model model;
    const auto error = [&](const voile::MeshCloth& cloth)
    {
        const auto result = model.add(cloth);
        return result ? std::string() : result.error().message;
    };
    CHECK(error(instance(cooked, glm::scale(glm::mat4(1), glm::vec3(1.001f)))) ==
          "cloth \"cloth\": its transform changes the shape that it was cooked in: it may turn and move it");
    CHECK(error(instance(cooked, glm::scale(glm::mat4(1), glm::vec3(-1, 1, 1)))).find("changes the shape") !=
          std::string::npos);
    voile::MeshCloth cloth = instance(cooked);
    cloth.material = voile::Material();
    CHECK(error(cloth) == "cloth \"cloth\": it was cooked with a Fabric and cannot have a Material");
    const tests::ClothMesh mesh = tests::rough_sheet(4, 3);
    cloth = instance(cooked);
    cloth.positions = mesh.positions;
    CHECK(error(cloth).find("must be empty") != std::string::npos);
    cloth = mesh.cloth();
    cloth.material = voile::Fabric();
    cloth = instance(take(voile::cook(cloth)));
    CHECK(error(cloth) == "cloth \"cloth\": isometric bending of a mesh must be there when it is cooked");
    cloth = instance(cooked);
    cloth.transform[3].x = 2e6f;
    CHECK(error(cloth).find("its transform takes vertex 0") != std::string::npos);
    CHECK(model.cloths.size() == 0);
    CHECK_FALSE(voile::cook(voile::MeshCloth()));
}

TEST_CASE("a cooked collider equals its mesh to the bit, also by way of bytes, and its instances share it")
{
    const tests::ClothMesh mesh = tests::octahedron();
    glm::mat4 transform = glm::rotate(glm::mat4(2.f), 0.4f, glm::vec3(1, 0, 1));
    transform[3] = glm::vec4(0.3f, 5, 1, 1);
    const voile::MeshCollider collider{
        .positions = mesh.positions, .triangles = mesh.triangles, .transform = transform};
    const voile::CookedCollider cooked = take(voile::cook(collider));
    CHECK(cooked.triangles() == 8);
    const Bytes bytes = cooked.bytes();
    const voile::CookedCollider loaded = take(voile::CookedCollider::load(bytes));
    CHECK(loaded.bytes() == bytes);

    voile::ColliderModels models;
    REQUIRE(models.add(collider));
    REQUIRE(models.add(voile::MeshCollider{.transform = transform, .cooked = loaded}));
    const voile::ColliderModel own = *models.colliders.at(0);
    const voile::ColliderModel other = *models.colliders.at(1);
    CHECK(same_bits(*own.hierarchy, *other.hierarchy));
    CHECK(own.origin == other.origin);
    CHECK(own.placement == other.placement);
    voile::shared::ColliderRecord record = other.record;
    record.first_node = own.record.first_node;
    record.first_triangle = own.record.first_triangle;
    CHECK(std::memcmp(&own.record, &record, sizeof(record)) == 0);

    glm::mat4 moved = transform;
    moved[3].x += 4;
    REQUIRE(models.add(voile::MeshCollider{.transform = moved, .cooked = loaded}));
    REQUIRE(
        models.add(voile::MeshCollider{.transform = glm::rotate(moved, 1.f, glm::vec3(0, 0, 1)), .cooked = loaded}));
    CHECK(glm::distance(models.colliders.at(2)->origin, own.origin + glm::dvec3(4, 0, 0)) < 1e-6);
    CHECK((models.colliders.at(2)->record.flags & VOILE_COLLIDER_MOVED) == 0);
    CHECK((models.colliders.at(3)->record.flags & VOILE_COLLIDER_MOVED) != 0);
    CHECK(models.colliders.at(3)->hierarchy == loaded.state()->hierarchy);

    const auto error = [&](const voile::MeshCollider& wrong)
    {
        const auto result = models.add(wrong);
        return result ? std::string() : result.error().message;
    };
    CHECK(error({.transform = glm::mat4(1), .cooked = loaded}).find("changes the shape") != std::string::npos);
    CHECK(error({.transform = transform, .deforms = true, .cooked = loaded}) ==
          "collider \"mesh\": it is cooked and cannot deform");
    moved[3].x = 1e6f;
    CHECK(error({.transform = moved, .cooked = loaded}).find("a corner of its box") != std::string::npos);
    CHECK(error({.positions = mesh.positions, .transform = transform, .cooked = loaded}).find("must be empty") !=
          std::string::npos);
}

namespace
{

// A job system of a host: a thread for each of four at a time.
void run_on_pool(void* user, uint32_t count, voile::Jobs::Task task, void* data)
{
    *static_cast<uint32_t*>(user) += count;
    std::atomic<uint32_t> next = 0;
    std::vector<std::jthread> pool;
    for (int i = 0; i < 4; ++i)
        pool.emplace_back(
            [&]
            {
                for (uint32_t index = next++; index < count; index = next++)
                    task(data, index);
            });
}

} // namespace

TEST_CASE("cooked bytes do not depend on whose threads cook")
{
    const voile::engine::Mesh ball = voile::engine::make_sphere({0, 0, 0}, 1, 100);
    const voile::MeshCollider collider{.positions = ball.positions, .triangles = ball.triangles};
    voile::set_hierarchy_cache_limit(0);
    const Bytes expected = take(voile::cook(collider)).bytes();
    for (const auto run : {tests::run_backwards, run_on_pool})
    {
        uint32_t tasks = 0;
        const voile::Jobs jobs{.run = run, .user = &tasks, .workers = 7};
        const voile::CookedCollider cooked = take(voile::cook(collider, jobs));
        CHECK(tasks > 0);
        CHECK(cooked.bytes() == expected);
        tasks = 0;
        CHECK(take(voile::CookedCollider::load(expected, {}, jobs)).bytes() == expected);
        CHECK(tasks > 0);
    }
    voile::set_hierarchy_cache_limit(voile::k_default_hierarchy_cache_limit);
}

TEST_CASE("damaged cooked data is refused, every byte of it")
{
    try_damaged<voile::CookedCloth>(cooked_sheet().bytes());
    try_damaged<voile::CookedCollider>(cooked_octahedron().bytes());
}

TEST_CASE("cooked data that somebody made up is refused or safe to use, word by word")
{
    try_hostile_words<voile::CookedCloth>(cooked_sheet().bytes());
    try_hostile_words<voile::CookedCollider>(cooked_octahedron().bytes());
}

TEST_CASE("cooked data names the reason why it is refused")
{
    const Bytes bytes = cooked_sheet().bytes();
    const auto reason = [&](size_t at, uint32_t value)
    {
        Bytes changed = bytes;
        std::memcpy(changed.data() + at, &value, sizeof(value));
        return voile::CookedCloth::load(changed).error().message;
    };
    CHECK(reason(0, 0) == "cooked data: it does not begin as cooked data does");
    CHECK(reason(8, voile::k_cooked_version + 1) ==
          "cooked data: it has version " + std::to_string(voile::k_cooked_version + 1) +
              ", this module reads version " + std::to_string(voile::k_cooked_version) + ": cook it again");
    CHECK(reason(12, 0x04030201) == "cooked data: it was cooked on a machine with another byte order");
    CHECK(voile::CookedCollider::load(bytes).error().message == "cooked data: it is not a collider");
    CHECK(reason(100, 5) == "cooked data: its checksum is wrong: it was changed or damaged");
}

TEST_CASE("bytes with an owner are not copied, and live as long as what was loaded from them")
{
    auto bytes = std::make_shared<const Bytes>(cooked_sheet().bytes());
    const std::weak_ptr<const Bytes> watched = bytes;
    auto loaded = take(voile::CookedCloth::load(*bytes, bytes));
    const auto* first = reinterpret_cast<const std::byte*>(loaded.state()->positions.data());
    CHECK(first > bytes->data());
    CHECK(first < bytes->data() + bytes->size());
    bytes.reset();
    CHECK_FALSE(watched.expired());
    loaded = {};
    CHECK(watched.expired());
}
