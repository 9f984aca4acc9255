// Random changes of cloths, colliders, anchors and attachments, before uploads and between an upload and the step of
// the same command buffer. A cloth that has nothing to do with them moves as it does alone.
#include "support/cloth_harness.hpp"
#include "support/cloth_meshes.hpp"
#include "support/collider_scenes.hpp"
#include "support/odd_meshes.hpp"
#include "support/random_cloths.hpp"

#include "voile/engine/assets/shapes.hpp"
#include "voile/fabrics.hpp"

#include <memory>
#include <optional>

namespace
{

using tests::ClothHarness;
using tests::Draw;
using tests::moved;
using tests::same_bits;
using voile::engine::take;

tests::ClothMesh draw_shape(Draw& draw)
{
    constexpr tests::ClothMesh (*k_shapes[])() = {tests::t_junctions, tests::doubled_triangles, tests::fan,
                                                  tests::loose_ends,  tests::octahedron,        tests::shuffled_sheet,
                                                  tests::open_seam,   tests::open_seam};
    return k_shapes[draw.count(0, static_cast<uint32_t>(std::size(k_shapes)) - 1)]();
}

voile::Fabric soft_fabric(Draw& draw)
{
    voile::Fabric fabric = draw.chance(0.5) ? voile::wool() : voile::silk();
    if (draw.chance(0.7))
        fabric.strain_limit = draw.in(0.002f, 0.1f);
    return fabric;
}

std::vector<voile::Attachment> draw_attachments(Draw& draw, uint32_t vertices, std::optional<voile::AnchorId> anchor)
{
    std::vector<voile::Attachment> result;
    for (uint32_t vertex = draw.count(0, 3); vertex < vertices; vertex += draw.count(1, vertices / 4))
    {
        voile::Attachment a = draw.chance(0.4)   ? voile::pin(vertex)
                              : draw.chance(0.5) ? voile::spring(vertex, draw.in(0.1f, 100), 0.01f)
                                                 : voile::max_distance(vertex, 0.02f);
        if (anchor && draw.chance(0.5))
            a = a.to(*anchor);
        result.push_back(a);
    }
    result[0] = voile::pin(result[0].vertex); // so that there can be tethers
    return result;
}

// One cloth with colliders and an anchor of its own, and random changes of them.
class Group
{
public:
    Group(voile::Solver& solver, uint32_t seed, uint32_t index)
        : solver_(solver), draw_(seed), layers_(1u << index % 32), x_(3 * static_cast<float>(index))
    {
        add_cloth();
        add_ball();
        add_table();
    }

    void remove()
    {
        take(solver_.remove(cloth_));
        for (const voile::ColliderId id : colliders_)
            take(solver_.remove(id));
        if (anchor_)
            take(solver_.remove(*anchor_));
    }

    void change()
    {
        constexpr void (Group::*k_changes[])() = {
            &Group::set_attachments, &Group::tether,       &Group::untether,        &Group::remove_anchor,
            &Group::add_ball,        &Group::add_table,    &Group::add_wave,        &Group::remove_collider,
            &Group::change_collider, &Group::toggle_cloth, &Group::toggle_collider, &Group::change_cloth};
        (this->*k_changes[draw_.count(0, static_cast<uint32_t>(std::size(k_changes)) - 1)])();
    }

    void move(float time)
    {
        for (const auto& [id, mesh] : waves_)
            if (solver_.enabled(id))
                take(solver_.deform_collider(id, tests::transformed(mesh.positions, moved({0, 0.3f * time, 0}))));
        take(solver_.move_collider(colliders_[0], moved({0, 0.4f * time, 0})));
        if (anchor_)
            take(solver_.move_anchor(*anchor_, moved({x_, 1 + 0.2f * time, 0})));
    }

    [[nodiscard]] voile::ClothId cloth() const { return cloth_; }

private:
    void add_cloth()
    {
        const auto integrator = tests::draw_integrator(draw_);
        if (draw_.chance(0.6))
        {
            const tests::ClothMesh shape = draw_shape(draw_);
            voile::MeshCloth mesh = shape.cloth();
            mesh.material = soft_fabric(draw_);
            mesh.transform = moved({x_ - 0.3f, 1, -0.3f});
            mesh.integrator = integrator;
            mesh.layers = layers_;
            cloth_ = take(solver_.add_cloth(mesh));
            vertices_ = static_cast<uint32_t>(shape.positions.size());
        }
        else
        {
            voile::GridCloth grid = tests::flat_sheet(12, 0.6f, 0);
            grid.material = soft_fabric(draw_);
            grid.transform = moved({x_, 1, 0});
            grid.integrator = integrator;
            grid.layers = layers_;
            cloth_ = take(solver_.add_cloth(grid));
        }
        if (draw_.chance(0.7))
            set_attachments();
        if (draw_.chance(0.5))
            tether();
    }

    void change_cloth()
    {
        take(solver_.set_enabled(cloth_, true));
        if (draw_.chance(0.3))
            take(solver_.set_material(cloth_, soft_fabric(draw_)));
        else if (draw_.chance(0.5))
            take(solver_.set_velocity(cloth_, 3.f * draw_.direction()));
        else
            take(solver_.reset(cloth_));
    }

    void toggle_cloth() { take(solver_.set_enabled(cloth_, !solver_.enabled(cloth_))); }

    void untether() { take(solver_.set_tethers(cloth_, std::nullopt)); }

    void tether()
    {
        const auto& attached = solver_.attachments(cloth_);
        if (std::ranges::any_of(attached, [](const voile::Attachment& a) { return std::isinf(a.stiffness); }))
            take(solver_.set_tethers(cloth_, voile::Tethers{.stretch = 0.1f}));
    }

    void set_attachments()
    {
        if (!anchor_ && draw_.chance(0.5))
            anchor_ = take(solver_.add_anchor(moved({x_, 1, 0})));
        take(solver_.set_attachments(cloth_, draw_attachments(draw_, vertices_, anchor_)));
    }

    void remove_anchor()
    {
        if (anchor_)
            take(solver_.remove(*anchor_));
        anchor_.reset();
    }

    void toggle_collider()
    {
        const voile::ColliderId id = colliders_.back();
        take(solver_.set_enabled(id, !solver_.enabled(id)));
    }

    void change_collider()
    {
        take(solver_.set_layers(colliders_.back(), draw_.chance(0.5) ? layers_ : 0));
        take(solver_.set_friction(colliders_.back(), voile::Friction{0.5f, 0.4f}));
        take(solver_.set_radius(colliders_.front(), draw_.uniform(0.05f, 0.2f)));
    }

    void remove_collider()
    {
        if (colliders_.size() == 1)
            return;
        std::erase_if(waves_, [&](const auto& wave) { return wave.first == colliders_.back(); });
        take(solver_.remove(colliders_.back()));
        colliders_.pop_back();
    }

    void add_ball()
    {
        add(voile::SphereCollider{.center = {x_ + draw_.uniform(-0.2f, 0.2f), 0.85f, 0}, .radius = 0.1f});
    }

    voile::engine::Mesh box(float height)
    {
        const float x = x_ + draw_.uniform(-0.2f, 0.1f);
        return voile::engine::make_box({x, 0.6f, -0.1f}, {x + 0.2f, height, 0.1f});
    }

    // At most two, the ball first: a vertex that touches several colliders collides with them in the order of their
    // indices, and a third could get a lower one than the second.
    void add(voile::Collider collider)
    {
        std::visit([&](auto& any) { any.layers = layers_; }, collider);
        if (colliders_.size() < 2)
            colliders_.push_back(take(solver_.add_collider(collider)));
    }

    void add_table()
    {
        const voile::engine::Mesh table = box(0.95f);
        add(tests::collider(table));
    }

    void add_wave()
    {
        const voile::engine::Mesh wave = box(0.9f);
        const size_t before = colliders_.size();
        add(tests::deforming(wave));
        if (colliders_.size() > before)
            waves_.emplace_back(colliders_.back(), wave);
    }

    voile::Solver& solver_;
    Draw draw_;
    uint32_t layers_;
    float x_;
    voile::ClothId cloth_;
    uint32_t vertices_ = 144;
    std::vector<voile::ColliderId> colliders_;
    std::vector<std::pair<voile::ColliderId, voile::engine::Mesh>> waves_; // they deform
    std::optional<voile::AnchorId> anchor_;
};

// A solver with the group that is compared, and perhaps others that change at random.
class World
{
public:
    World(uint32_t seed, bool others)
        : harness(options(others)), subject(harness.solver, seed, 0), others_(others), draw_(seed + 1000)
    {
        if (others)
            for (uint32_t i = 0; i < 3; ++i)
                add_group(seed + 7 * i);
        for (int i = 0; i < 9; ++i) // always more colliders than are walked without lists of near ones
            take(harness.solver.add_collider(voile::SphereCollider{.center = {0, -50, 0}, .layers = 0}));
        harness.upload();
    }

    // Without others, which change the passes of most steps, commands are used again.
    static voile::SolverOptions options(bool others)
    {
        voile::SolverOptions options;
        options.tuning.dispatch_vertices = 1;
        if (!others)
            options.command_reuse = {.queue_family = tests::device().queue_family(), .steps_in_flight = 1};
        return options;
    }

    void change()
    {
        if (groups_.empty() || draw_.chance(0.2))
            add_group(draw_.count(0, 1u << 20));
        else if (draw_.chance(0.15))
        {
            const size_t i = draw_group();
            groups_[i]->remove();
            groups_.erase(groups_.begin() + static_cast<std::ptrdiff_t>(i));
        }
        else
            groups_[draw_group()]->change();
    }

    void change_others()
    {
        for (uint32_t i = others_ ? draw_.count(0, 3) : 0; i > 0; --i)
            change();
    }

    // `substeps`: 0: as needed. Returns those of the subject.
    uint32_t frame(uint32_t index, uint32_t substeps, bool upload)
    {
        const float time = static_cast<float>(index) / 60;
        change_others();
        voile::Upload kept;
        uint32_t used = 0;
        harness.run(
            [&](VkCommandBuffer cmd)
            {
                if (upload || (others_ && draw_.chance(0.3)))
                    kept = take(harness.solver.record_upload(cmd));
                change_others();
                subject.move(time);
                for (const auto& group : groups_)
                    group->move(time);
                voile::Step step;
                step.wind = {1, 0, 2};
                step.gust = 0.3f;
                step.time = static_cast<double>(time);
                step.substeps = substeps;
                step.max_substeps = most_substeps_;
                used = harness.solver.stability(subject.cloth(), step).used;
                take(harness.solver.record(cmd, step));
            });
        return used;
    }

    void check_finite()
    {
        for (const auto& group : groups_)
            if (harness.solver.vertices(group->cloth()).vertices > 0)
                harness.positions(group->cloth());
    }

    std::vector<glm::vec4> positions() { return harness.positions(subject.cloth()); }

    ClothHarness harness;
    Group subject;

private:
    void add_group(uint32_t seed)
    {
        ++count_;
        groups_.push_back(std::make_unique<Group>(harness.solver, seed, count_ % 31 + 1));
    }
    size_t draw_group() { return draw_.count(0, static_cast<uint32_t>(groups_.size()) - 1); }

    bool others_;
    Draw draw_;
    std::vector<std::unique_ptr<Group>> groups_;
    uint32_t count_ = 0;
    uint32_t most_substeps_ = draw_.chance(0.5) ? 8 : 24;
};

} // namespace

TEST_CASE("random changes of other cloths change no bit of a cloth")
{
    uint32_t reused = 0;
    for (const uint32_t seed : {15u, 16u, 101u, 107u})
    {
        CAPTURE(seed);
        World together(seed, true);
        World alone(seed, false);
        Draw draw(seed);
        for (uint32_t i = 0; i < 18; ++i)
        {
            CAPTURE(i);
            const bool changes = draw.chance(0.3);
            if (changes)
            {
                together.subject.change();
                alone.subject.change();
            }
            const uint32_t used = together.frame(i, 0, changes);
            alone.frame(i, used, changes);
            reused += alone.harness.solver.record_report().reused ? 1 : 0;
            together.check_finite();
            REQUIRE(same_bits(together.positions(), alone.positions()));
        }
    }
    CHECK(reused > 13);
}
