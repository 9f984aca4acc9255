// Upload: new buffers for everything that was added, and the copies that fill them.
#include "geometry/parallel.hpp"
#include "solver/solver_state.hpp"

#include <algorithm>
#include <bit>

namespace voile
{

namespace
{

// Bytes of a buffer, in the pieces in which their owners have them.
using Pieces = std::vector<std::span<const std::byte>>;

class Uploader
{
public:
    Uploader(const gpu::Context& context, VkCommandBuffer cmd) : context_(context), cmd_(cmd) {}

    // Stages the pieces one after the other for `destination` at `offset`; nothing for no bytes.
    Result<void> stage(const gpu::Buffer& destination, VkDeviceSize offset, const Pieces& pieces)
    {
        size_t bytes = 0;
        for (const auto& piece : pieces)
            bytes += piece.size();
        if (bytes == 0)
            return {};
        auto staging =
            gpu::create_buffer(context_, "cloth staging", bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, Memory::upload);
        if (!staging)
            return staging.error();
        auto end = staging.value().mapped().begin();
        for (const auto& piece : pieces)
            end = std::copy(piece.begin(), piece.end(), end);
        staging.value().flush();
        copies_.push_back({staging.value().handle(), destination.handle(), {0, offset, bytes}});
        staging_.push_back(std::move(staging.value()));
        return {};
    }

    void copy(const gpu::Buffer& source, const gpu::Buffer& destination, VkDeviceSize bytes)
    {
        if (bytes > 0)
            copies_.push_back({source.handle(), destination.handle(), {0, 0, bytes}});
    }

    // Copies touch different buffers, or different ranges, so that one barrier before and one after suffice.
    std::vector<gpu::Buffer> record(const Scope& after)
    {
        constexpr VkAccessFlags2KHR k_copy = VK_ACCESS_2_TRANSFER_READ_BIT_KHR | VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR;
        gpu::Recorder recorder(context_, cmd_);
        recorder.barrier(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT_KHR, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT_KHR,
                         VK_PIPELINE_STAGE_2_COPY_BIT_KHR, k_copy);
        const gpu::LabelScope scope(context_, cmd_, "cloth upload");
        for (const Copy& copy : copies_)
            context_.fn.vkCmdCopyBuffer(cmd_, copy.source, copy.destination, 1, &copy.region);
        recorder.barrier(
            VK_PIPELINE_STAGE_2_COPY_BIT_KHR, k_copy, after.stages | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT_KHR,
            after.accesses | VK_ACCESS_2_SHADER_STORAGE_READ_BIT_KHR | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT_KHR);
        return std::move(staging_);
    }

private:
    struct Copy
    {
        VkBuffer source;
        VkBuffer destination;
        VkBufferCopy region;
    };

    const gpu::Context& context_;
    VkCommandBuffer cmd_;
    std::vector<gpu::Buffer> staging_;
    std::vector<Copy> copies_;
};

// Planes have their origins near where the cloths that meet them start.
void place_planes(Solver::State& solver)
{
    for (size_t i = 0; i < solver.colliders.size(); ++i)
    {
        ColliderModel& plane = solver.collider_models.colliders[i];
        if (!plane.plane_offset)
            continue;
        Extent all;
        for (const ClothModel& cloth : solver.model.cloths)
            if ((cloth.record.layers & plane.record.layers) != 0)
                all.join(cloth.extent);
        if (all.empty())
            continue;
        const glm::dvec4 middle(0.5 * (all.min + all.max), 1);
        place_plane(plane, glm::dvec3(glm::inverse(glm::dmat4(solver.colliders[i].to)) * middle));
    }
}

template <typename T>
Pieces bytes_of(const std::vector<T>& values)
{
    return {std::as_bytes(std::span(values))};
}

// One member of each object, one after the other.
template <typename Object, typename Member>
Pieces bytes_of(std::span<const Object> objects, const Member& member)
{
    Pieces pieces;
    pieces.reserve(objects.size());
    for (const Object& object : objects)
        if (const auto* values = member(object))
            pieces.push_back(std::as_bytes(std::span(*values)));
    return pieces;
}

template <typename Object, typename Value>
std::vector<Value> values_of(const std::vector<Object>& objects, Value Object::*member)
{
    std::vector<Value> values;
    values.reserve(objects.size());
    for (const Object& object : objects)
        values.push_back(object.*member);
    return values;
}

// The vertices of all meshes, their lists counted from the first entries of all. Counts these in `data`.
std::vector<shared::MeshVertex> list_vertices(const Model& model, UploadData& data)
{
    std::vector<shared::MeshVertex> vertices;
    vertices.reserve(model.mesh_vertices);
    for (const ClothModel& cloth : model.cloths)
    {
        if (!cloth.lists)
            continue;
        for (shared::MeshVertex vertex : cloth.lists->vertices)
        {
            vertex.first_spring += static_cast<uint32_t>(data.springs);
            vertex.first_corner += static_cast<uint32_t>(data.corners);
            vertices.push_back(vertex);
        }
        data.springs += cloth.lists->springs.size();
        data.corners += cloth.lists->corners.size();
    }
    return vertices;
}

// One set per collider, its offsets those of all features.
void count_features(const ColliderModels& models, UploadData& data)
{
    for (const ColliderModel& collider : models.colliders)
    {
        shared::FeatureSet& set = data.feature_sets.emplace_back(collider.features->set);
        if (set.features == 0)
            continue;
        set.first_node = static_cast<uint32_t>(data.feature_nodes);
        set.first_feature = static_cast<uint32_t>(data.features);
        data.feature_nodes += collider.features->nodes.size();
        data.features += collider.features->features.size();
    }
}

// An array of the lists of each mesh, in a piece per cloth.
template <typename T>
Pieces bytes_of(const Model& model, SharedArray<T> MeshLists::*member)
{
    return bytes_of(std::span<const ClothModel>(model.cloths),
                    [&](const ClothModel& cloth) { return cloth.lists ? &((*cloth.lists).*member) : nullptr; });
}

// An array of each of these cloths.
template <typename T>
Pieces bytes_of(std::span<const ClothModel> cloths, std::vector<T> ClothModel::*member)
{
    return bytes_of(cloths, [&](const ClothModel& cloth) { return &(cloth.*member); });
}

// An array of each hierarchy, or of the features of each collider.
template <typename Owner, typename Array>
Pieces bytes_of(const ColliderModels& models, std::shared_ptr<const Owner> ColliderModel::*owner, Array Owner::*member)
{
    return bytes_of(std::span<const ColliderModel>(models.colliders), [&](const ColliderModel& collider)
                    { return collider.*owner ? &((*(collider.*owner)).*member) : nullptr; });
}

// From now on the state is the GPU's.
void forget_uploaded(Solver::State& solver)
{
    for (ClothModel& cloth : solver.model.cloths)
    {
        cloth.positions = {};
        cloth.velocities = {};
    }
    for (DeformingMesh& mesh : solver.collider_models.deforming)
        mesh.positions = {};
}

} // namespace

Result<Upload> Solver::record_upload(VkCommandBuffer cmd)
{
    State& s = *state_;
    const JobScope scope(s.options.jobs);
    s.attachment_lists = make_attachment_lists(s.model);
    UploadData data;
    data.patches = make_patches(s.model, s.options.tuning.workgroup_size);
    if (s.options.feature_contact)
    {
        update_features(s.collider_models, s.model);
        count_features(s.collider_models, data);
    }
    const std::vector<shared::MeshVertex> mesh_vertices = list_vertices(s.model, data);
    static constexpr uint32_t k_room = 16; // for holds and anchors that come later
    const auto room = [](size_t count) { return std::bit_ceil(std::max(static_cast<uint32_t>(count), k_room)); };
    data.anchors = room(s.anchors.size());
    data.attachments = room(s.attachment_lists.attachments.size());
    data.tethers = room(s.attachment_lists.tethers.size());
    auto created = create_device_state(s.context, s.kernels, s.model, s.collider_models, data, s.statistics);
    if (!created)
        return created.error();
    DeviceState& next = created.value();

    // Cloths that were there before go on from where they are; the others start from the model.
    const size_t kept = s.device ? s.device->vertices : 0;
    const size_t kept_deforming = s.device ? s.device->deforming_vertices : 0;
    const VkDeviceSize kept_bytes = kept * sizeof(glm::vec4);
    const VkDeviceSize kept_residual_bytes = kept * sizeof(glm::uvec2);
    const size_t kept_cloths = s.device ? s.device->cloth_count : 0;
    const VkDeviceSize kept_votes = votes_bytes(kept_cloths);
    const std::vector<std::byte> no_votes(votes_bytes(s.model.cloths.size()) - kept_votes);
    const VkDeviceSize kept_scales = scales_bytes(kept_cloths);
    Uploader uploader(s.context, cmd);
    const std::vector<glm::vec4> up(s.model.vertices - kept, glm::vec4(0, 1, 0, 0));
    place_planes(s);
    std::vector<shared::ColliderMotion> motions;
    for (uint32_t i = 0; i < s.colliders.size(); ++i)
        motions.push_back(make_motion(s.collider_models, i, s.colliders[i], s.deformations));
    const std::vector<shared::ClothRecord> records = values_of(s.model.cloths, &ClothModel::record);
    const std::vector<shared::ColliderRecord> collider_records =
        values_of(s.collider_models.colliders, &ColliderModel::record);
    std::vector<shared::AnchorRecord> anchors;
    for (const Anchor& anchor : s.anchors)
        anchors.push_back(make_record(anchor));
    const std::vector<shared::LimitScale> limit_scales(s.model.cloths.size() - kept_cloths,
                                                       shared::LimitScale{1, 1, 0, 1, 0, 0});
    const std::span<const ClothModel> added = std::span(s.model.cloths).subspan(kept_cloths);
    const ColliderModels& colliders = s.collider_models;
    const std::span<const DeformingMesh> deforming(colliders.deforming);
    const std::span<const DeformingMesh> added_deforming = deforming.subspan(s.device ? s.device->deforming_count : 0);
    struct Staged
    {
        const gpu::Buffer& destination;
        VkDeviceSize offset;
        Pieces pieces;
    };
    const Staged staged[] = {
        {next[buffer::cloths], 0, bytes_of(records)},
        {next[buffer::patches], 0, bytes_of(data.patches.patches)},
        {next[buffer::mesh_vertices], 0, bytes_of(mesh_vertices)},
        {next[buffer::mesh_springs], 0, bytes_of(s.model, &MeshLists::springs)},
        {next[buffer::mesh_corners], 0, bytes_of(s.model, &MeshLists::corners)},
        {next[buffer::membrane_corners], 0, bytes_of(s.model, &MeshLists::membrane)},
        {next[buffer::colliders], 0, bytes_of(collider_records)},
        {next[buffer::collider_motions], 0, bytes_of(motions)},
        {next[buffer::deforming_positions], kept_deforming * sizeof(glm::vec4),
         bytes_of(added_deforming, [](const DeformingMesh& mesh) { return &mesh.positions; })},
        {next[buffer::padded_leaves], 0, bytes_of(deforming, [](const DeformingMesh& mesh) { return &mesh.leaves; })},
        {next[buffer::bvh_nodes], 0, bytes_of(colliders, &ColliderModel::hierarchy, &Bvh::nodes)},
        {next[buffer::bvh_triangles], 0, bytes_of(colliders, &ColliderModel::hierarchy, &Bvh::triangles)},
        {next[buffer::feature_sets], 0, bytes_of(data.feature_sets)},
        {next[buffer::feature_nodes], 0, bytes_of(colliders, &ColliderModel::features, &ColliderFeatures::nodes)},
        {next[buffer::features], 0, bytes_of(colliders, &ColliderModel::features, &ColliderFeatures::features)},
        {next[buffer::start], 0, bytes_of(s.model.cloths, &ClothModel::start)},
        {next[buffer::start_residuals], 0, bytes_of(s.model.cloths, &ClothModel::residuals)},
        {next[buffer::anchors], 0, bytes_of(anchors)},
        {next[buffer::attachments], 0, bytes_of(s.attachment_lists.attachments)},
        {next[buffer::tethers], 0, bytes_of(s.attachment_lists.tethers)},
        {next[buffer::limit_scales], kept_scales, bytes_of(limit_scales)},
        {next[buffer::positions], kept_bytes, bytes_of(added, &ClothModel::positions)},
        {next[buffer::residuals], kept_residual_bytes, bytes_of(added, &ClothModel::residuals)},
        {next[buffer::velocities], kept_bytes, bytes_of(added, &ClothModel::velocities)},
        {next[buffer::normals], kept_bytes, bytes_of(up)},
        {next[buffer::recovery_votes_a], kept_votes, bytes_of(no_votes)},
        {next[buffer::recovery_votes_b], kept_votes, bytes_of(no_votes)},
    };
    for (const Staged& item : staged)
        if (auto result = uploader.stage(item.destination, item.offset, item.pieces); !result)
            return result.error();
    if (s.device)
    {
        uploader.copy((*s.device)[buffer::positions], next[buffer::positions], kept_bytes);
        uploader.copy((*s.device)[buffer::residuals], next[buffer::residuals], kept_residual_bytes);
        uploader.copy((*s.device)[buffer::velocities], next[buffer::velocities], kept_bytes);
        uploader.copy((*s.device)[buffer::normals], next[buffer::normals], kept_bytes);
        uploader.copy((*s.device)[buffer::limit_scales], next[buffer::limit_scales], kept_scales);
        for (size_t i = 0; i < 2; ++i)
            uploader.copy((*s.device)[k_recovery_votes[i]], next[k_recovery_votes[i]], kept_votes);
        uploader.copy((*s.device)[buffer::deforming_positions], next[buffer::deforming_positions],
                      kept_deforming * sizeof(glm::vec4));
    }

    Upload upload;
    upload.contents_ = std::make_unique<Upload::Contents>();
    if (checks_lifetime(s.options))
    {
        auto check = LifetimeCheck::create(s.context, "voile::Upload");
        if (!check)
            return check.error();
        upload.contents_->lifetime = std::move(check.value());
    }
    s.lifetime.begin(cmd);
    upload.contents_->lifetime.begin(cmd);
    upload.contents_->staging = uploader.record(host_scopes(s.options).after);
    gpu::Recorder recorder(s.context, cmd);
    forget_candidates(recorder, next);
    // What a recorded step reads may not have been written: steps can be recorded and not submitted.
    clear_dispatch(recorder, next[buffer::feature_dispatch].handle());
    for (size_t i = 0; i < 2; ++i)
        clear_dispatch(recorder, next[buffer::depenetrations].handle(), recovery_word(i));
    if (s.edits.attachments) // what is no longer held has its mass again
        for (uint32_t cloth = 0; s.device && cloth < s.device->cloth_count; ++cloth)
            s.edits.places.push_back({glm::mat4(1), glm::vec3(0), VOILE_EDIT_MASSES, cloth});
    upload.contents_->replaced = std::move(s.device);
    s.device = std::move(next);
    s.dirty = false;
    forget_uploaded(s);
    s.edits.records.clear();
    s.edits.colliders.clear();
    record_uploaded_boxes(recorder, s);
    upload.contents_->lifetime.end(cmd);
    s.lifetime.end(cmd);
    s.history.normals_due = true;
    s.history.recovery_due = true;
    s.edits.attachments = s.edits.tethers = false;
    s.update_passes();
    return upload;
}

} // namespace voile
