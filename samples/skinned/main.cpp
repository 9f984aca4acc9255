// A sleeve on an arm that bends: a mesh of cloth, pinned to the upper of two bones, over a collider that both bones
// skin. The same vertices are drawn and collide. Here the host skins them; an engine that skins on the GPU hands its
// buffer to Solver::deform_collider (DeviceVertices) and nothing else changes. With a display this opens a window.
// Without one (--headless [FRAMES]) it simulates a second, writes skinned.png and prints what the statistics say.
#include "samples/arguments.hpp"
#include "samples/progress.hpp"

#include "voile/cloth_component.hpp"
#include "voile/fabrics.hpp"

#include "voile/engine/app/app.hpp"
#include "voile/engine/assets/atomic_file.hpp"
#include "voile/engine/assets/shapes.hpp"
#include "voile/engine/render/readback.hpp"
#include "voile/engine/scene/deforming_mesh.hpp"
#include "voile/engine/scene/static_mesh.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <cstdio>
#include <exception>
#include <numbers>

namespace
{

using voile::engine::FrameInfo;

constexpr float k_elbow = 1;          // m, height
constexpr float k_half_length = 0.4f; // m, of the arm
constexpr float k_radius = 0.08f;     // m
constexpr uint32_t k_rings = 20;      // vertices of the sleeve along the arm
constexpr uint32_t k_segments = 28;   // around it

// The arm, straight: an ellipsoid along y.
voile::engine::Mesh straight_arm()
{
    voile::engine::Mesh mesh = voile::engine::make_sphere({0, 0, 0}, 1, 40);
    for (glm::vec3& p : mesh.positions)
        p = glm::vec3(k_radius, k_half_length, k_radius) * p + glm::vec3(0, k_elbow, 0);
    return mesh;
}

// World from rest, of the upper bone, which swings about the shoulder, and of the lower one, which also bends.
struct Pose
{
    glm::mat4 upper;
    glm::mat4 lower;
};

glm::mat4 turn_about(const glm::vec3& point, float angle, const glm::vec3& axis)
{
    return glm::translate(glm::mat4(1.f), point) * glm::rotate(glm::mat4(1.f), angle, axis) *
           glm::translate(glm::mat4(1.f), -point);
}

Pose pose_at(double time)
{
    const auto bend = static_cast<float>(0.6 * (1 - std::cos(std::numbers::pi * time)));
    const auto swing = static_cast<float>(0.3 * std::sin(std::numbers::pi * time));
    const glm::mat4 upper = turn_about({0, k_elbow + k_half_length, 0}, swing, {1, 0, 0});
    return {upper, upper * turn_about({0, k_elbow, 0}, bend, {1, 0, 0})};
}

// Linear blend skinning, with weights that blend over 12 cm around the elbow.
glm::vec3 skinned(const Pose& pose, const glm::vec3& p)
{
    const float lower = glm::smoothstep(0.06f, -0.06f, p.y - k_elbow);
    return glm::mix(glm::vec3(pose.upper * glm::vec4(p, 1)), glm::vec3(pose.lower * glm::vec4(p, 1)), lower);
}

// A component that skins the arm, for the picture and for the solver, and moves the anchor of the upper bone.
class Arm : public voile::engine::Component
{
public:
    Arm(voile::component::ClothWorld& world, voile::engine::UploadBatch& uploads, uint32_t slots)
        : world_(world), rest_(straight_arm()), positions_(rest_.positions),
          collider_(world.add_collider(voile::MeshCollider{
              .name = "arm", .positions = rest_.positions, .triangles = rest_.triangles, .deforms = true})),
          bone_(voile::engine::take(world.solver().add_anchor(glm::mat4(1.f)))),
          mesh_(uploads, slots, rest_, voile::engine::Surface{.base_color{0.75f, 0.55f, 0.45f}}, "arm")
    {
    }

    [[nodiscard]] voile::AnchorId upper_bone() const { return bone_; }

    void update(const FrameInfo& frame) override
    {
        const double time = frame.time + static_cast<double>(frame.time_step);
        const Pose pose = pose_at(time);
        for (size_t i = 0; i < positions_.size(); ++i)
            positions_[i] = skinned(pose, rest_.positions[i]);
        voile::engine::take(world_.solver().deform_collider(collider_, positions_));
        voile::engine::take(world_.solver().move_anchor(bone_, pose.upper));
        mesh_.set_positions(positions_);
    }

    void record_compute(VkCommandBuffer cmd, const FrameInfo& frame) override { mesh_.record_compute(cmd, frame); }
    void record_draw(VkCommandBuffer cmd, voile::engine::View& view) override { mesh_.record_draw(cmd, view); }

private:
    voile::component::ClothWorld& world_;
    voile::engine::Mesh rest_;
    std::vector<glm::vec3> positions_;
    voile::ColliderId collider_;
    voile::AnchorId bone_;
    voile::engine::DeformingMesh mesh_;
};

// A tube around the arm: close to it at its upper end, wide at its lower one.
voile::engine::Mesh sleeve()
{
    voile::engine::Mesh mesh;
    for (uint32_t ring = 0; ring < k_rings; ++ring)
        for (uint32_t segment = 0; segment < k_segments; ++segment)
        {
            const float down = static_cast<float>(ring) / (k_rings - 1);
            const float along = 0.25f - 0.5f * down; // m, above the elbow
            const float arm = k_radius * std::sqrt(1 - along * along / (k_half_length * k_half_length));
            const float radius = arm + 0.005f + 0.03f * down;
            const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(segment) / k_segments;
            mesh.positions.emplace_back(radius * std::cos(angle), k_elbow + along, radius * std::sin(angle));
            mesh.texture_coordinates.emplace_back(radius * angle, 0.5f * down);
        }
    for (uint32_t ring = 0; ring + 1 < k_rings; ++ring)
        for (uint32_t segment = 0; segment < k_segments; ++segment)
        {
            const uint32_t a = ring * k_segments + segment;
            const uint32_t b = ring * k_segments + (segment + 1) % k_segments;
            mesh.triangles.emplace_back(a, b, a + k_segments);
            mesh.triangles.emplace_back(b, b + k_segments, a + k_segments);
        }
    return mesh;
}

// Adds the sleeve and pins its upper ring to the bone.
voile::ClothId add_sleeve(voile::Solver& solver, voile::AnchorId bone)
{
    const voile::engine::Mesh mesh = sleeve();
    const voile::ClothId cloth =
        voile::engine::take(solver.add_cloth(voile::MeshCloth{.name = "sleeve",
                                                              .positions = mesh.positions,
                                                              .triangles = mesh.triangles,
                                                              .texture_coordinates = mesh.texture_coordinates,
                                                              .material = voile::cotton(),
                                                              .integrator = voile::Integrator::verlet}));
    std::vector<voile::Attachment> pins;
    for (uint32_t segment = 0; segment < k_segments; ++segment)
        pins.push_back(voile::pin(segment, bone));
    voile::engine::take(solver.set_attachments(cloth, pins));
    return cloth;
}

void run(const samples::Arguments& arguments)
{
    samples::Progress progress(arguments.frames);
    voile::engine::App app({.title = "a sleeve", .headless = arguments.headless});
    if (!app.has_window()) // before the simulation: an output that cannot be written is reported at once
        (void)voile::engine::take(voile::engine::AtomicFile::create("skinned.png"));
    voile::engine::Scene& scene = app.scene();
    scene.camera = {.position = {1.5f, 1.15f, 0.9f}, .target = {0, 0.98f, 0.1f}, .fov = 32};
    scene.focus = {0, 0.8f, 0};
    scene.focus_radius = 1.2f;

    auto& world = scene.add("cloth").add<voile::component::ClothWorld>(app.device(), app.slots());
    world.collect_statistics = true;
    auto& arm = scene.add("arm").add<Arm>(world, app.uploads(), app.slots());
    const voile::ClothId cloth = add_sleeve(world.solver(), arm.upper_bone());
    scene.add("sleeve").add<voile::component::Sheet>(
        world, app.uploads(), cloth, voile::component::fabric_surface({0.12f, 0.3f, 0.22f}, {0.4f, 0.42f, 0.3f}, 1));
    scene.add("ground").add<voile::engine::StaticMesh>(app.uploads(), voile::engine::make_ground(60),
                                                       voile::engine::ground_surface());

    voile::engine::Readback readback(app.device(), app.renderer().extent(), app.slots());
    const voile::engine::IdleGuard idle(app.device());
    voile::Statistics last;
    uint32_t last_slot = 0;
    app.draws = [frames = arguments.frames](const FrameInfo& frame) { return frame.index + 1 == frames; };
    app.after_render = [&](VkCommandBuffer cmd, const FrameInfo& frame)
    {
        if (!app.has_window() && app.draws(frame))
            readback.record(cmd, app.renderer().color(), last_slot = frame.slot);
    };
    app.completed = [&](const FrameInfo& frame)
    {
        last = world.solver().statistics(frame.slot);
        if (!app.has_window())
            progress.update(frame.index + 1);
    };
    app.run(arguments.frames);
    if (app.has_window())
        return;
    voile::engine::take(voile::engine::save_png("skinned.png", readback.picture(last_slot)));
    std::printf("wrote skinned.png\n");
    std::printf("%u vertices touch the arm, %u are inside, the largest stretch is %.3f\n", last.contacts,
                last.penetrating_vertices, static_cast<double>(last.max_stretch));
}

} // namespace

int main(int argc, char** argv)
{
    try
    {
        if (const auto arguments = samples::parse_arguments("skinned", argc, argv))
            run(*arguments);
        return 0;
    }
    catch (const std::exception& error)
    {
        std::fprintf(stderr, "skinned: %s\n", error.what());
        return 1;
    }
}
