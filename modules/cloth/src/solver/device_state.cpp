// DeviceState: allocation and descriptor sets.
#include "solver/device_state.hpp"

#include <array>

namespace voile
{

namespace
{

struct BufferRequest
{
    gpu::Buffer* buffer = nullptr;
    const char* name = nullptr;
    VkDeviceSize bytes = 0;
};

gpu::Result<void> create_buffers(const gpu::Context& context, DeviceState& state, const Model& model,
                                 const UploadData& data)
{
    const size_t patch_count = data.patches.patches.size();
    constexpr VkBufferUsageFlags k_usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT |
                                           VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                           VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    const VkDeviceSize votes = votes_bytes(model.records.size());
    const VkDeviceSize per_vertex = model.positions.size() * sizeof(glm::vec4);
    const VkDeviceSize per_residual = model.positions.size() * sizeof(glm::uvec2);
    const BufferRequest requests[] = {
        {&state.cloths, "cloth records", model.records.size() * sizeof(shared::ClothRecord)},
        {&state.patches, "cloth patches", patch_count * sizeof(shared::Patch)},
        {&state.mesh_vertices, "cloth mesh vertices", data.lists.vertices.size() * sizeof(shared::MeshVertex)},
        {&state.mesh_springs, "cloth mesh springs", data.lists.springs.size() * sizeof(shared::MeshSpring)},
        {&state.mesh_corners, "cloth mesh corners", data.lists.corners.size() * sizeof(shared::MeshCorner)},
        {&state.membrane_corners, "cloth membrane corners",
         data.lists.membrane.size() * sizeof(shared::MembraneCorner)},
        {&state.colliders, "cloth colliders", model.colliders.size() * sizeof(shared::ColliderRecord)},
        {&state.collider_motions, "cloth collider motions", model.colliders.size() * sizeof(shared::ColliderMotion)},
        {&state.deforming_input, "cloth deforming input", model.deforming_positions.size() / 2 * k_most_stride},
        {&state.deforming_positions, "cloth deforming positions", model.deforming_positions.size() * sizeof(glm::vec4)},
        {&state.padded_leaves, "cloth padded leaves", model.padded_leaves.size() * sizeof(shared::PaddedLeaf)},
        {&state.padded_boxes, "cloth padded boxes", model.padded_boxes * sizeof(shared::PaddedBox)},
        {&state.nodes, "cloth bvh nodes", model.nodes.size() * sizeof(shared::BvhNode)},
        {&state.triangles, "cloth bvh triangles", model.triangles.size() * sizeof(shared::BvhTriangle)},
        {&state.feature_sets, "cloth feature sets", data.features.sets.size() * sizeof(shared::FeatureSet)},
        {&state.feature_nodes, "cloth feature nodes", data.features.nodes.size() * sizeof(shared::BvhNode)},
        {&state.features, "cloth features", data.features.features.size() * sizeof(shared::Feature)},
        {&state.feature_corrections, "cloth feature corrections",
         data.features.features.empty() ? 0 : model.positions.size() * sizeof(shared::FeatureCorrection)},
        {&state.feature_patches, "cloth feature patches", patch_count * sizeof(uint32_t)},
        {&state.feature_dispatch, "cloth feature dispatch", sizeof(VkDispatchIndirectCommand)},
        {&state.recovery_votes[0], "cloth recovery votes a", votes},
        {&state.recovery_votes[1], "cloth recovery votes b", votes},
        {&state.depenetrations, "cloth depenetrations",
         2 * VOILE_DISPATCH_WORDS * sizeof(uint32_t) + model.positions.size() * sizeof(shared::Depenetration)},
        {&state.near_colliders, "cloth near colliders", patch_count * state.near_stride * sizeof(uint32_t)},
        {&state.start, "cloth start", per_vertex},
        {&state.start_residuals, "cloth start residuals", per_residual},
        {&state.anchors, "cloth anchors", data.anchors * sizeof(shared::AnchorRecord)},
        {&state.attachments, "cloth holds", data.attachments * sizeof(shared::AttachmentRecord)},
        {&state.tethers, "cloth tethers", data.tethers * sizeof(shared::TetherRecord)},
        {&state.state.positions, "cloth positions", per_vertex},
        {&state.state.residuals, "cloth position residuals", per_residual},
        {&state.state.velocities, "cloth velocities", per_vertex},
        {&state.stage_a.positions, "cloth stage a positions", per_vertex},
        {&state.stage_a.residuals, "cloth stage a residuals", per_residual},
        {&state.stage_a.velocities, "cloth stage a velocities", per_vertex},
        {&state.stage_b.positions, "cloth stage b positions", per_vertex},
        {&state.stage_b.residuals, "cloth stage b residuals", per_residual},
        {&state.stage_b.velocities, "cloth stage b velocities", per_vertex},
        {&state.stage_c.positions, "cloth stage c positions", per_vertex},
        {&state.stage_c.residuals, "cloth stage c residuals", per_residual},
        {&state.stage_c.velocities, "cloth stage c velocities", per_vertex},
        {&state.candidate_places, "cloth candidate places", per_vertex},
        {&state.candidate_triangles, "cloth candidate triangles",
         model.positions.size() * VOILE_CANDIDATE_WORDS * sizeof(uint32_t)},
        {&state.normals, "cloth normals", per_vertex},
        {&state.limit_works[0], "cloth limit works a", patch_count * sizeof(shared::LimitWork)},
        {&state.limit_works[1], "cloth limit works b", patch_count * sizeof(shared::LimitWork)},
        {&state.limit_works[2], "cloth limit works c", patch_count * sizeof(shared::LimitWork)},
        {&state.limit_works[3], "cloth limit works d", patch_count * sizeof(shared::LimitWork)},
        {&state.step_start.positions, "cloth step start positions", per_vertex},
        {&state.step_start.residuals, "cloth step start residuals", per_residual},
        {&state.step_start.velocities, "cloth step start velocities", per_vertex},
        {&state.limit_scales, "cloth limit scales", scales_bytes(model.records.size())},
        {&state.partials, "cloth statistics partials", patch_count * sizeof(shared::StatisticsRecord)},
    };
    for (const BufferRequest& request : requests)
    {
        auto buffer = gpu::create_buffer(context, request.name, request.bytes, k_usage, gpu::Memory::device);
        if (!buffer)
            return buffer.error();
        *request.buffer = std::move(buffer.value());
    }
    return {};
}

// Words per patch of the lists of near colliders; none for a few colliders, nor where the lists would be too large.
uint32_t near_stride(uint32_t colliders, uint32_t patches, uint64_t max_bytes)
{
    const uint32_t stride = VOILE_NEAR_WORDS + (colliders + 31) / 32;
    const bool fits = uint64_t{patches} * stride * sizeof(uint32_t) <= max_bytes;
    return colliders > VOILE_NEAR_FEW && fits ? stride : 0;
}

// Binds `buffers` to `kernel` and stores the set; keeps the first error.
struct Binder
{
    gpu::BindingPool& pool;
    gpu::Result<void> status = {};

    void bind(VkDescriptorSet& set, const gpu::Kernel& kernel, std::initializer_list<VkBuffer> buffers)
    {
        auto result = pool.bind(kernel, buffers);
        if (result)
            set = result.value();
        else if (status)
            status = result.error();
    }
};

// Where a substep that begins in the state, or one that begins in stage B, leaves what it proposes.
struct Proposal
{
    const StateBuffers& earlier;
    const StateBuffers& state;
    const gpu::Buffer& earlier_predicted; // Verlet's
    const gpu::Buffer& predicted;
};

Proposal proposal(const DeviceState& s, size_t parity)
{
    if (parity == 0)
        return {s.state, s.stage_b, s.stage_a.velocities, s.stage_c.velocities};
    return {s.stage_b, s.state, s.stage_c.velocities, s.stage_a.velocities};
}

// What acts on the state a substep proposes, and what acts on the state between steps.
void bind_attachments(DeviceState& s, const Kernels& kernels, Binder& binder)
{
    binder.bind(s.pins, kernels.pins,
                {s.attachments.handle(), s.anchors.handle(), s.state.positions.handle(), s.state.velocities.handle(),
                 s.state.residuals.handle()});
    for (size_t i = 0; i < 2; ++i)
    {
        const Proposal p = proposal(s, i);
        binder.bind(s.proposed_attachments[i], kernels.attachments,
                    {s.attachments.handle(), s.anchors.handle(), s.cloths.handle(), p.state.positions.handle(),
                     p.state.velocities.handle(), p.predicted.handle(), p.state.residuals.handle()});
        binder.bind(s.proposed_tethers[i], kernels.tethers,
                    {s.tethers.handle(), s.cloths.handle(), p.state.positions.handle(), p.state.velocities.handle(),
                     p.predicted.handle(), p.state.residuals.handle(), p.earlier.positions.handle()});
    }
    binder.bind(s.edit, kernels.edit,
                {s.cloths.handle(), s.start.handle(), s.state.positions.handle(), s.state.velocities.handle(),
                 s.start_residuals.handle(), s.state.residuals.handle()});
    const auto bind_strain = [&](VkDescriptorSet& set, const StateBuffers& input, const StateBuffers& output)
    {
        binder.bind(set, kernels.limit_strain,
                    {s.cloths.handle(), s.patches.handle(), input.positions.handle(), input.velocities.handle(),
                     output.positions.handle(), output.velocities.handle(), s.mesh_vertices.handle(),
                     s.mesh_springs.handle(), s.state.positions.handle(), s.state.velocities.handle(),
                     input.residuals.handle(), output.residuals.handle()});
    };
    bind_strain(s.strain_first, s.state, s.stage_b);
    bind_strain(s.strain_back, s.stage_b, s.stage_a);
    bind_strain(s.strain_forth, s.stage_a, s.stage_b);
}

// The strain limit's energy: the state before it stands in stage A, its velocities in stage C's positions.
void bind_limit_guard(DeviceState& s, const Kernels& kernels, Binder& binder)
{
    using Buffers = std::array<VkBuffer, 3>;
    const Buffers start = {s.step_start.positions.handle(), s.step_start.velocities.handle(),
                           s.step_start.residuals.handle()};
    const Buffers before = {s.stage_a.positions.handle(), s.stage_c.positions.handle(), s.stage_a.residuals.handle()};
    const Buffers after = {s.state.positions.handle(), s.state.velocities.handle(), s.state.residuals.handle()};
    const auto bind_work = [&](size_t i, const Buffers& here, const Buffers& from, const Buffers& to)
    {
        binder.bind(s.limit_work[i], kernels.limit_work,
                    {s.cloths.handle(), s.patches.handle(), here[0], here[1], here[2], s.mesh_vertices.handle(),
                     s.mesh_springs.handle(), s.mesh_corners.handle(), from[0], from[1], from[2], to[0], to[1], to[2],
                     s.limit_works[i].handle(), start[0], start[2], s.membrane_corners.handle()});
    };
    bind_work(0, start, start, before);
    bind_work(1, before, start, before);
    bind_work(2, before, before, after);
    bind_work(3, after, before, after);
    binder.bind(s.limit_scale, kernels.limit_scale,
                {s.patches.handle(), s.limit_works[0].handle(), s.limit_works[1].handle(), s.limit_works[2].handle(),
                 s.limit_works[3].handle(), s.limit_scales.handle()});
    binder.bind(s.limit_guard, kernels.limit_guard,
                {s.cloths.handle(), s.patches.handle(), s.limit_scales.handle(), before[0], before[1], before[2],
                 after[0], after[1], after[2]});
}

void bind_contact(DeviceState& s, const Kernels& kernels, Binder& binder)
{
    for (size_t parity = 0; parity < 2; ++parity)
    {
        const Proposal p = proposal(s, parity);
        binder.bind(s.contact[parity], kernels.contact,
                    {s.cloths.handle(),
                     s.patches.handle(),
                     p.state.positions.handle(),
                     p.state.velocities.handle(),
                     p.earlier.positions.handle(),
                     p.earlier.velocities.handle(),
                     s.colliders.handle(),
                     s.nodes.handle(),
                     s.triangles.handle(),
                     s.mesh_vertices.handle(),
                     s.mesh_corners.handle(),
                     p.predicted.handle(),
                     p.earlier_predicted.handle(),
                     s.candidate_places.handle(),
                     s.candidate_triangles.handle(),
                     s.collider_motions.handle(),
                     s.padded_boxes.handle(),
                     s.padded_leaves.handle(),
                     s.deforming_positions.handle(),
                     s.feature_corrections.handle(),
                     p.state.residuals.handle(),
                     p.earlier.residuals.handle(),
                     s.depenetrations.handle(),
                     s.near_colliders.handle()});
        for (size_t votes = 0; votes < 2; ++votes)
            binder.bind(s.feature_contact[parity][votes], kernels.feature_contact,
                        {s.cloths.handle(), s.patches.handle(), p.state.positions.handle(), p.state.velocities.handle(),
                         s.feature_corrections.handle(), s.feature_patches.handle(), p.predicted.handle(),
                         s.mesh_vertices.handle(), s.mesh_corners.handle(), s.colliders.handle(),
                         s.collider_motions.handle(), s.feature_sets.handle(), s.feature_nodes.handle(),
                         s.features.handle(), p.earlier.positions.handle(), s.near_colliders.handle(),
                         p.state.residuals.handle(), p.earlier.residuals.handle(), s.recovery_votes[votes].handle()});
    }
    binder.bind(s.feature_reach, kernels.feature_reach,
                {s.cloths.handle(), s.patches.handle(), s.state.positions.handle(), s.state.velocities.handle(),
                 s.colliders.handle(), s.collider_motions.handle(), s.feature_sets.handle(), s.feature_nodes.handle(),
                 s.feature_dispatch.handle(), s.feature_patches.handle(), s.near_colliders.handle()});
    binder.bind(s.collider_reach, kernels.collider_reach,
                {s.cloths.handle(), s.patches.handle(), s.state.positions.handle(), s.state.velocities.handle(),
                 s.colliders.handle(), s.collider_motions.handle(), s.padded_boxes.handle(), s.feature_sets.handle(),
                 s.near_colliders.handle()});
}

gpu::Result<void> bind_sets(DeviceState& s, const Kernels& kernels, const gpu::Buffer& statistics)
{
    Binder binder{s.pool};
    const auto bind_stage = [&](VkDescriptorSet& set, const StateBuffers& base, const StateBuffers& third,
                                const StateBuffers& input, const StateBuffers& output)
    {
        binder.bind(set, kernels.stage,
                    {s.cloths.handle(), s.patches.handle(), base.positions.handle(), base.velocities.handle(),
                     input.positions.handle(), input.velocities.handle(), output.positions.handle(),
                     output.velocities.handle(), s.stage_a.velocities.handle(), third.velocities.handle(),
                     s.mesh_vertices.handle(), s.mesh_springs.handle(), s.mesh_corners.handle(),
                     base.residuals.handle(), input.residuals.handle(), output.residuals.handle(),
                     s.membrane_corners.handle()});
    };
    for (size_t parity = 0; parity < 2; ++parity)
    {
        const StateBuffers& base = proposal(s, parity).earlier;
        const StateBuffers& other = proposal(s, parity).state;
        bind_stage(s.stages[parity][0], base, other, base, s.stage_a);
        bind_stage(s.stages[parity][1], base, other, s.stage_a, other);
        bind_stage(s.stages[parity][2], base, other, other, s.stage_c);
        bind_stage(s.stages[parity][3], base, other, s.stage_c, other);
    }
    bind_stage(s.last_stage_alone, s.state, s.stage_b, s.stage_c, s.state);
    // Of a Verlet cloth: positions, velocities at their time or predicted for it, velocities half a substep before.
    struct Motion
    {
        const gpu::Buffer& positions;
        const gpu::Buffer& residuals;
        const gpu::Buffer& gathered;
        const gpu::Buffer& velocities;
    };
    const Motion start{s.state.positions, s.state.residuals, s.state.velocities, s.state.velocities};
    const Motion here{s.state.positions, s.state.residuals, s.stage_a.velocities, s.state.velocities};
    const Motion there{s.stage_b.positions, s.stage_b.residuals, s.stage_c.velocities, s.stage_b.velocities};
    const auto bind_verlet = [&](VkDescriptorSet& set, const Motion& input, const Motion& output)
    {
        binder.bind(set, kernels.verlet,
                    {s.cloths.handle(), s.patches.handle(), input.positions.handle(), input.gathered.handle(),
                     input.velocities.handle(), output.positions.handle(), output.velocities.handle(),
                     output.gathered.handle(), s.mesh_vertices.handle(), s.mesh_springs.handle(),
                     s.mesh_corners.handle(), input.residuals.handle(), output.residuals.handle(),
                     s.membrane_corners.handle()});
    };
    bind_verlet(s.verlet_first, start, there);
    bind_verlet(s.verlet_forth, here, there);
    bind_verlet(s.verlet_back, there, here);
    // The last kick leaves positions alone; what it would write of them goes where nobody looks.
    bind_verlet(s.verlet_last, here,
                {s.stage_b.positions, s.stage_b.residuals, s.stage_c.velocities, s.state.velocities});
    bind_verlet(s.verlet_last_back, there, here);
    bind_attachments(s, kernels, binder);
    bind_limit_guard(s, kernels, binder);
    bind_contact(s, kernels, binder);
    for (size_t i = 0; i < 2; ++i)
        binder.bind(s.recover[i], kernels.recover,
                    {s.cloths.handle(), s.patches.handle(), s.state.positions.handle(), s.depenetrations.handle(),
                     s.normals.handle(), s.colliders.handle(), s.collider_motions.handle(), s.nodes.handle(),
                     s.triangles.handle(), s.padded_boxes.handle(), s.padded_leaves.handle(),
                     s.deforming_positions.handle(), s.recovery_votes[i].handle(), s.recovery_votes[1 - i].handle(),
                     s.near_colliders.handle(), s.state.residuals.handle()});
    binder.bind(s.deform, kernels.deform, {s.deforming_input.handle(), s.deforming_positions.handle()});
    binder.bind(s.refit, kernels.refit.leaves,
                {s.padded_leaves.handle(), s.deforming_positions.handle(), s.padded_boxes.handle()});
    binder.bind(s.normals_set, kernels.normals,
                {s.cloths.handle(), s.patches.handle(), s.state.positions.handle(), s.normals.handle(),
                 s.mesh_vertices.handle(), s.mesh_corners.handle(), s.state.residuals.handle()});
    binder.bind(s.statistics, kernels.statistics,
                {s.cloths.handle(), s.patches.handle(), s.state.positions.handle(), s.state.velocities.handle(),
                 s.colliders.handle(), s.nodes.handle(), s.triangles.handle(), s.partials.handle(),
                 s.mesh_vertices.handle(), s.mesh_springs.handle(), s.collider_motions.handle(),
                 s.candidate_triangles.handle(), s.padded_boxes.handle(), s.padded_leaves.handle(),
                 s.deforming_positions.handle(), s.state.residuals.handle(), s.near_colliders.handle()});
    binder.bind(s.statistics_reduce, kernels.statistics_reduce, {s.partials.handle(), statistics.handle()});
    return binder.status;
}

} // namespace

gpu::Result<DeviceState> create_device_state(const gpu::Context& context, const Kernels& kernels, const Model& model,
                                             const UploadData& data, const gpu::Buffer& statistics)
{
    DeviceState state;
    state.vertices = static_cast<uint32_t>(model.positions.size());
    state.patch_count = static_cast<uint32_t>(data.patches.patches.size());
    state.deforming_vertices = model.deforming_positions.size();
    state.deforming_count = model.deforming.size();
    state.rk4_patches = data.patches.rk4;
    state.anchor_capacity = data.anchors;
    state.attachment_capacity = data.attachments;
    state.tether_capacity = data.tethers;
    state.feature_count = static_cast<uint32_t>(data.features.features.size());
    state.cloth_count = static_cast<uint32_t>(model.cloths.size());
    state.collider_count = static_cast<uint32_t>(model.colliders.size());
    state.near_stride = near_stride(state.collider_count, state.patch_count, model.max_buffer_bytes);
    if (auto buffers = create_buffers(context, state, model, data); !buffers)
        return buffers.error();
    constexpr uint32_t k_sets = 44;
    auto pool = gpu::BindingPool::create(context, k_sets, k_sets * k_most_storage_buffers);
    if (!pool)
        return pool.error();
    state.pool = std::move(pool.value());
    if (auto sets = bind_sets(state, kernels, statistics); !sets)
        return sets.error();
    return state;
}

} // namespace voile
