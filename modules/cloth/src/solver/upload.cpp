// Upload: copies new cloths and colliders into the solver's buffers, which grow if they are too small.
#include "geometry/closedness.hpp"
#include "geometry/owned_edges.hpp"
#include "geometry/parallel.hpp"
#include "solver/solver_state.hpp"
#include "solver/staged_cloths.hpp"
#include "solver/staging.hpp"

#include <utility>

namespace voile
{

namespace
{

// The origin of a plane is near the start of the cloths that collide with it.
void set_plane_origin(const Model& cloths, ColliderModel& plane)
{
    Extent all;
    for (const auto [index, cloth] : cloths.cloths)
        if ((cloth.record.layers & plane.record.layers) != 0)
            all.join(cloth.extent);
    if (all.empty())
        return;
    const glm::dvec4 middle(0.5 * (all.min + all.max), 1);
    set_plane_origin(plane, glm::dvec3(glm::inverse(glm::dmat4(plane.pose.to)) * middle));
}

void stage_collider(Staging& staging, const ColliderModel& collider, uint32_t index)
{
    staging.add_copy(buffer::colliders, index, std::vector{shown_record(collider)});
    staging.add_copy(buffer::collider_motions, index, std::vector{make_motion(collider)});
    if (collider.uploaded || !collider.deforming)
        return;
    const DeformingMesh& mesh = *collider.deforming;
    std::vector<glm::vec4> positions;
    for (const glm::vec3& p : mesh.positions)
        positions.emplace_back(p, 0);
    for (uint32_t half = 0; half < 2; ++half)
        staging.add_copy(buffer::deforming_positions, mesh.first(half), positions);
    staging.add(buffer::padded_leaves, collider.record.first_triangle, mesh.leaves);
}

// The edges that the triangles of a rigid mesh own. Vertices at the same position are one.
std::vector<uint32_t> bvh_edges(const Bvh& bvh)
{
    std::vector<glm::vec3> corners;
    corners.reserve(3 * bvh.triangles.size());
    for (const shared::BvhTriangle& t : bvh.triangles)
        corners.insert(corners.end(), {t.a, t.b, t.c});
    const std::vector<uint32_t> welded = weld(corners);
    std::vector<glm::uvec3> triangles(bvh.triangles.size());
    for (size_t i = 0; i < triangles.size(); ++i)
        triangles[i] = {welded[3 * i], welded[3 * i + 1], welded[3 * i + 2]};
    const std::vector<uint8_t> owned = owned_edges(triangles);
    return {owned.begin(), owned.end()};
}

using FeaturePlacement = SharedRanges<ColliderFeatures, k_feature_arrays>::Placement;

// The features of meshes that deform. Sources and slots count from the first entries of all meshes.
void stage_deforming(Staging& staging, const FeaturePlacement& placement)
{
    const DeformingFeatures& features = placement.owner->deforming;
    std::vector<shared::FeatureSource> sources = features.sources;
    for (shared::FeatureSource& source : sources)
    {
        source.stand_in += static_cast<uint32_t>(placement.first[k_feature_sources]);
        source.first_hinge += static_cast<uint32_t>(placement.first[k_feature_hinges]);
    }
    std::vector<uint32_t> slots = features.slots;
    for (uint32_t& slot : slots)
        slot += static_cast<uint32_t>(placement.first[k_feature_sources]) << VOILE_SLOT_FEATURE_BITS;
    staging.add_copy(buffer::feature_sources, placement.first[k_feature_sources], sources);
    staging.add_copy(buffer::feature_slots, placement.first[k_feature_slots], slots);
    staging.add(buffer::feature_hinges, placement.first[k_feature_hinges], features.hinges);
}

// The features of one collider, its offsets those in the buffers of all.
shared::FeatureSet placed_set(const FeaturePlacement& placement, bool deforms)
{
    shared::FeatureSet set = placement.owner->set;
    set.first_node = static_cast<uint32_t>(placement.first[deforms ? k_feature_slots : k_feature_nodes]);
    set.first_feature = static_cast<uint32_t>(placement.first[deforms ? k_feature_sources : k_feature_list]);
    set.first_facing = static_cast<uint32_t>(placement.first[k_feature_facings]);
    return set;
}

void stage_features(Staging& staging, const ColliderModels& models, const ColliderModel& collider, uint32_t index)
{
    shared::FeatureSet set{};
    if (collider.features)
        set = placed_set(*models.features.find(collider.features.get()), collider.deforming.has_value());
    staging.add_copy(buffer::feature_sets, index, std::vector{set});
}

// Everything that is new since the last upload, and planes, whose origins follow the cloths.
Staging stage_new(Solver::State& solver)
{
    Staging staging;
    ColliderModels& models = solver.collider_models;
    stage_cloths(staging, solver.model, solver.options.output);
    staging.add_copy(buffer::deforming_reach, 0, std::vector<uint32_t>{0});
    for (auto [index, collider] : models.colliders)
    {
        const shared::ColliderRecord before = collider.record;
        if (collider.plane_offset)
            set_plane_origin(solver.model, collider);
        if (!collider.uploaded || before.origin != collider.record.origin)
            stage_collider(staging, collider, index);
        if (!collider.uploaded || collider.features_new)
            stage_features(staging, models, collider, index);
    }
    models.hierarchies.for_each_new(
        [&](const auto& placement)
        {
            staging.add(buffer::bvh_nodes, placement.first[k_hierarchy_nodes], placement.owner->nodes);
            staging.add(buffer::bvh_triangles, placement.first[k_hierarchy_triangles], placement.owner->triangles);
            if (solver.options.intersections)
                staging.add_copy(buffer::bvh_edges, placement.first[k_hierarchy_triangles],
                                 bvh_edges(*placement.owner));
        });
    models.features.for_each_new(
        [&](const auto& placement)
        {
            staging.add(buffer::feature_nodes, placement.first[k_feature_nodes], placement.owner->nodes);
            staging.add(buffer::features, placement.first[k_feature_list], placement.owner->features);
            stage_deforming(staging, placement);
        });
    return staging;
}

uint64_t count_pair_places(const Model& model)
{
    uint64_t places = 0;
    for (const auto [index, cloth] : model.cloths)
        places += cloth.pair_order.size();
    return places;
}

PairCloths pair_cloths(const Model& model)
{
    PairCloths cloths;
    for (const auto [index, cloth] : model.cloths)
        if (!cloth.pair_order.empty())
            cloths = {cloths.count + 1, index + 1};
    return cloths;
}

// Few vertices of coarse cloth may need many items each.
uint64_t feature_item_room(const Tuning& tuning, uint64_t vertices)
{
    if (tuning.feature_items)
        return vertices * *tuning.feature_items;
    constexpr uint64_t k_most_more = VOILE_MOST_FEATURE_ITEMS - VOILE_FEATURE_ITEMS;
    return vertices * VOILE_FEATURE_ITEMS + std::min<uint64_t>(vertices * k_most_more, VOILE_MORE_FEATURE_ITEMS);
}

// The entries that the buffers must have room for.
BufferCounts count_entries(const Solver::State& solver)
{
    const Model& model = solver.model;
    const ColliderModels& models = solver.collider_models;
    const AttachmentCounts attached = count_attachments(model);
    const bool intersections = solver.options.intersections;
    const bool has_features = models.features.end(k_feature_list) + models.features.end(k_feature_sources) > 0;
    return {.cloths = model.cloths.size(),
            .vertices = model.vertices.end(),
            .patches = model.patches,
            .mesh_vertices = model.lists.end(k_list_vertices),
            .springs = model.lists.end(k_list_springs),
            .corners = model.lists.end(k_list_corners),
            .fans = model.fans.end(k_fan_vertices),
            .wedges = model.fans.end(k_fan_wedges),
            .owners = model.fans.end(k_fan_owners),
            .limit_vertices = model.limit_levels.end(k_limit_vertices),
            .limit_levels = model.limit_levels.end(k_limit_levels),
            .limit_links = model.limit_levels.end(k_limit_links),
            .limit_parents = model.limit_levels.end(k_limit_parents),
            .colliders = models.colliders.size(),
            .nodes = models.hierarchies.end(k_hierarchy_nodes),
            .triangles = models.hierarchies.end(k_hierarchy_triangles),
            .deforming_vertices = models.deforming_positions.end() / 2,
            .padded_leaves = models.padded_leaves.end(),
            .padded_boxes = models.padded_boxes.end(),
            .feature_nodes = models.features.end(k_feature_nodes),
            .features = models.features.end(k_feature_list),
            .feature_sources = models.features.end(k_feature_sources),
            .feature_hinges = models.features.end(k_feature_hinges),
            .feature_slots = models.features.end(k_feature_slots),
            .featured_vertices = has_features ? model.vertices.end() : 0,
            .feature_items = has_features ? feature_item_room(solver.options.tuning, model.vertices.end()) : 0,
            .anchors = attached.anchors,
            .attachments = attached.attachments,
            .tethers = attached.tethers,
            .previous_vertices = solver.options.output.previous_positions ? model.vertices.end() : 0,
            .cloth_triangles = model.triangles.end(),
            .pair_vertices = count_pair_places(model) > 0 ? model.vertices.end() : 0,
            .cloth_trees = model.trees.leaves() > 0 ? model.cloths.size() : 0,
            .cloth_leaves = model.trees.leaves(),
            .cloth_boxes = model.trees.boxes(),
            .bvh_edges = intersections ? models.hierarchies.end(k_hierarchy_triangles) : 0,
            .intersecting_vertices = intersections ? model.vertices.end() : 0};
}

NewDeforming new_deforming(const ColliderModels& models)
{
    NewDeforming found;
    for (const auto [index, collider] : models.colliders)
    {
        if (!collider.deforming)
            continue;
        if (!collider.uploaded)
            found.meshes.push_back(models.colliders.id_at(index));
        if (collider.features_new)
            found.features.push_back(models.colliders.id_at(index));
    }
    return found;
}

// From now on the GPU has the state.
void mark_uploaded(Solver::State& solver)
{
    for (auto [index, cloth] : solver.model.cloths)
    {
        cloth.uploaded = true;
        cloth.positions = {};
        cloth.velocities = {};
    }
    for (auto [index, collider] : solver.collider_models.colliders)
    {
        if (!collider.uploaded || collider.features_new)
            solver.wake_near(collider.record.layers);
        collider.uploaded = true;
        collider.features_new = false;
    }
    solver.model.lists.mark_uploaded();
    solver.model.fans.mark_uploaded();
    solver.model.limit_levels.mark_uploaded();
    solver.model.trees.mark_uploaded();
    solver.collider_models.hierarchies.mark_uploaded();
    solver.collider_models.features.mark_uploaded();
}

constexpr VkAccessFlags2KHR k_copy_accesses = VK_ACCESS_2_TRANSFER_READ_BIT_KHR | VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR;
// Copies the former contents, then what is new: both may go into the same buffer.
void record_copies(gpu::Recorder& recorder, const Solver::State& solver, std::span<const GrowthCopy> grown,
                   const Staging& staging, VkBuffer staged)
{
    const Scope before = host_scopes(solver.options).before;
    constexpr VkPipelineStageFlags2KHR k_transfer = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT_KHR;
    recorder.barrier(before.stages | k_transfer | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT_KHR,
                     before.accesses | VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT_KHR,
                     k_transfer, k_copy_accesses);
    const gpu::LabelScope scope(solver.context, recorder.cmd(), "cloth upload");
    for (const GrowthCopy& copy : grown)
        recorder.copy(copy.from, copy.to, {0, 0, copy.bytes});
    if (!grown.empty())
        recorder.barrier(k_transfer, k_copy_accesses, k_transfer, k_copy_accesses);
    staging.record(recorder, staged, *solver.device);
}

// New memory may have anything: what another solver remembered had the same numbers of passes.
void clear_memories(gpu::Recorder& recorder, const DeviceState& device)
{
    constexpr VkPipelineStageFlags2KHR k_transfer = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT_KHR;
    recorder.barrier(k_compute, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT_KHR, k_transfer,
                     VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR);
    for (const buffer::Name name : {buffer::pair_memories, buffer::pair_bounds})
        recorder.fill(device[name].handle(), 0);
    recorder.barrier(k_transfer, VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR, k_compute | k_transfer,
                     k_storage | VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR);
}

} // namespace

Result<Upload> Solver::record_upload(VkCommandBuffer cmd)
{
    State& s = *state_;
    const JobScope scope(s.options.jobs);
    if (s.options.feature_contact)
        update_features(s.collider_models, s.model);
    s.model.list_limit_levels();
    auto growth = grow(s.context, s.kernels, s.device ? &*s.device : nullptr, count_entries(s), s.statistics,
                       s.options.output.usage);
    if (!growth)
        return growth.error();
    auto outputs = write_outputs(s, growth.value());
    if (!outputs)
        return outputs.error();
    const Staging staging = stage_new(s);
    auto staged = staging.write(s.context);
    if (!staged)
        return staged.error();
    Upload upload;
    upload.contents_ = std::make_unique<Upload::Contents>();
    if (checks_lifetime(s.options))
    {
        auto check = LifetimeCheck::create(s.context, "voile::Upload");
        if (!check)
            return check.error();
        upload.contents_->lifetime = std::move(check.value());
    }
    // Nothing fails from here on.
    s.lifetime.begin(cmd);
    upload.contents_->lifetime.begin(cmd);
    const std::vector<GrowthCopy> copies = std::move(growth.value().copies);
    if (!s.device)
        s.device.emplace();
    s.replace_buffers(std::move(growth.value()));
    s.replace_outputs(std::move(outputs.value()));
    upload.contents_->replaced = std::exchange(s.replaced, {});
    upload.contents_->staging = std::move(staged.value());
    gpu::Recorder recorder(s.context, cmd);
    record_copies(recorder, s, copies, staging, upload.contents_->staging.handle());
    s.finish_upload(recorder);
    upload.contents_->lifetime.end(cmd);
    s.lifetime.end(cmd);
    return upload;
}

void Solver::State::replace_buffers(Growth growth)
{
    if (commands && growth.any)
        commands->forget();
    replaced.buffers.push_back(replace_grown(*device, std::move(growth)));
}

void Solver::State::finish_upload(gpu::Recorder& recorder)
{
    const NewDeforming deforming = new_deforming(collider_models);
    mark_uploaded(*this);
    device->pair_places = static_cast<uint32_t>(count_pair_places(model));
    device->pair_cloths = pair_cloths(model);
    update_patches();
    record_patches(recorder, *this);
    const Scope after = host_scopes(options).after;
    recorder.barrier(VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT_KHR, k_copy_accesses,
                     after.stages | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT_KHR, after.accesses | k_storage);
    forget_candidates(recorder, *device);
    clear_memories(recorder, *device);
    // What a recorded step reads may not have been written: steps can be recorded and not submitted.
    clear_dispatch(recorder, (*device)[buffer::feature_dispatch].handle());
    for (size_t i = 0; i < 2; ++i)
        clear_dispatch(recorder, (*device)[buffer::depenetrations].handle(), depenetration_word(i));
    if (options.intersections)
        clear_intersections(recorder, *device);
    record_at_rest(recorder, *this, deforming);
    history.normals_due = true;
    history.depenetration_due = true;
    history.pairs_met = false;
    history.features_listed = false;
    history.forget_pairs();
    dirty = false;
}

} // namespace voile
