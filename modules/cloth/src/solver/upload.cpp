// Upload: new buffers for everything that was added, and the copies that fill them.
#include "solver/solver_state.hpp"

#include <algorithm>
#include <bit>
#include <limits>

namespace voile
{

namespace
{

class Uploader
{
public:
    Uploader(const gpu::Context& context, VkCommandBuffer cmd) : context_(context), cmd_(cmd) {}

    // Stages `bytes` for `destination` at `offset`; nothing for no bytes.
    gpu::Result<void> stage(const gpu::Buffer& destination, VkDeviceSize offset, std::span<const std::byte> bytes)
    {
        if (bytes.empty())
            return {};
        auto staging = gpu::create_buffer(context_, "cloth staging", bytes.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                          gpu::Memory::upload);
        if (!staging)
            return staging.error();
        std::copy(bytes.begin(), bytes.end(), staging.value().mapped().begin());
        staging.value().flush();
        copies_.push_back({staging.value().handle(), destination.handle(), {0, offset, bytes.size()}});
        staging_.push_back(std::move(staging.value()));
        return {};
    }

    void copy(const gpu::Buffer& source, const gpu::Buffer& destination, VkDeviceSize bytes)
    {
        if (bytes > 0)
            copies_.push_back({source.handle(), destination.handle(), {0, 0, bytes}});
    }

    // Copies touch different buffers, or different ranges, so that one barrier before and one after suffice.
    std::vector<gpu::Buffer> record()
    {
        constexpr VkAccessFlags2KHR k_copy = VK_ACCESS_2_TRANSFER_READ_BIT_KHR | VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR;
        gpu::Recorder recorder(context_, cmd_);
        recorder.barrier(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT_KHR, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT_KHR,
                         VK_PIPELINE_STAGE_2_COPY_BIT_KHR, k_copy);
        const gpu::LabelScope scope(context_, cmd_, "cloth upload");
        for (const Copy& copy : copies_)
            context_.fn.vkCmdCopyBuffer(cmd_, copy.source, copy.destination, 1, &copy.region);
        recorder.barrier(VK_PIPELINE_STAGE_2_COPY_BIT_KHR, k_copy,
                         VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT_KHR | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT_KHR,
                         VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT_KHR | VK_ACCESS_2_SHADER_STORAGE_READ_BIT_KHR |
                             VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT_KHR);
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

struct Extent
{
    glm::dvec3 min{std::numeric_limits<double>::infinity()};
    glm::dvec3 max{-std::numeric_limits<double>::infinity()};

    void join(const Extent& other)
    {
        min = glm::min(min, other.min);
        max = glm::max(max, other.max);
    }
};

std::vector<Extent> cloth_extents(const Model& model)
{
    std::vector<Extent> extents(model.records.size());
    for (size_t c = 0; c < extents.size(); ++c)
        for (uint32_t i = 0; i < model.records[c].vertices; ++i)
        {
            const glm::dvec3 x(model.start[model.records[c].first_vertex + i]);
            extents[c].join({x, x});
        }
    return extents;
}

// Planes have their origins near where the cloths that meet them start.
void place_planes(Model& model, std::span<const ColliderPose> poses)
{
    const std::vector<Extent> extents = model.planes.empty() ? std::vector<Extent>() : cloth_extents(model);
    for (const Plane& plane : model.planes)
    {
        Extent all;
        for (size_t c = 0; c < extents.size(); ++c)
            if ((model.records[c].layers & model.colliders[plane.collider].layers) != 0)
                all.join(extents[c]);
        if (all.min.x > all.max.x)
            continue;
        const glm::dvec4 middle(0.5 * (all.min + all.max), 1);
        model.place_plane(plane, glm::dvec3(glm::inverse(glm::dmat4(poses[plane.collider].to)) * middle));
    }
}

template <typename T>
std::span<const std::byte> bytes_of(const std::vector<T>& values, size_t from = 0)
{
    return std::as_bytes(std::span(values).subspan(from));
}

} // namespace

Result<Upload> Solver::record_upload(VkCommandBuffer cmd)
{
    State& s = *state_;
    s.attachment_lists = make_attachment_lists(s.model);
    UploadData data;
    data.patches = make_patches(s.model, s.options.tuning.workgroup_size);
    if (s.options.feature_contact)
        data.features = find_features(s.model);
    data.lists =
        s.options.tuning.mesh_layout == MeshLayout::interleaved
            ? interleave(s.model, s.options.tuning.workgroup_size)
            : MeshLists{s.model.mesh_vertices, s.model.mesh_springs, s.model.mesh_corners, s.model.membrane_corners};
    static constexpr uint32_t k_room = 16; // for holds and anchors that come later
    const auto room = [](size_t count) { return std::bit_ceil(std::max(static_cast<uint32_t>(count), k_room)); };
    data.anchors = room(s.anchors.size());
    data.attachments = room(s.attachment_lists.attachments.size());
    data.tethers = room(s.attachment_lists.tethers.size());
    auto created = create_device_state(s.context, s.kernels, s.model, data, s.statistics);
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
    const std::vector<std::byte> no_votes(votes_bytes(s.model.records.size()) - kept_votes);
    const VkDeviceSize kept_scales = scales_bytes(kept_cloths);
    Uploader uploader(s.context, cmd);
    const std::vector<glm::vec4> up(s.model.positions.size() - kept, glm::vec4(0, 1, 0, 0));
    place_planes(s.model, s.colliders);
    std::vector<shared::ColliderMotion> motions;
    for (uint32_t i = 0; i < s.colliders.size(); ++i)
        motions.push_back(make_motion(s.model, i, s.colliders[i], s.deformations));
    std::vector<shared::AnchorRecord> anchors;
    for (const Anchor& anchor : s.anchors)
        anchors.push_back(make_record(anchor));
    const std::vector<shared::LimitScale> limit_scales(s.model.records.size() - kept_cloths,
                                                       shared::LimitScale{1, 1, 0, 1, 0, 0});
    struct Staged
    {
        const gpu::Buffer& destination;
        VkDeviceSize offset;
        std::span<const std::byte> bytes;
    };
    const Staged staged[] = {
        {next[buffer::cloths], 0, bytes_of(s.model.records)},
        {next[buffer::patches], 0, bytes_of(data.patches.patches)},
        {next[buffer::mesh_vertices], 0, bytes_of(data.lists.vertices)},
        {next[buffer::mesh_springs], 0, bytes_of(data.lists.springs)},
        {next[buffer::mesh_corners], 0, bytes_of(data.lists.corners)},
        {next[buffer::membrane_corners], 0, bytes_of(data.lists.membrane)},
        {next[buffer::colliders], 0, bytes_of(s.model.colliders)},
        {next[buffer::collider_motions], 0, bytes_of(motions)},
        {next[buffer::deforming_positions], kept_deforming * sizeof(glm::vec4),
         bytes_of(s.model.deforming_positions, kept_deforming)},
        {next[buffer::padded_leaves], 0, bytes_of(s.model.padded_leaves)},
        {next[buffer::bvh_nodes], 0, bytes_of(s.model.nodes)},
        {next[buffer::bvh_triangles], 0, bytes_of(s.model.triangles)},
        {next[buffer::feature_sets], 0, bytes_of(data.features.sets)},
        {next[buffer::feature_nodes], 0, bytes_of(data.features.nodes)},
        {next[buffer::features], 0, bytes_of(data.features.features)},
        {next[buffer::start], 0, bytes_of(s.model.start)},
        {next[buffer::start_residuals], 0, bytes_of(s.model.residuals)},
        {next[buffer::anchors], 0, bytes_of(anchors)},
        {next[buffer::attachments], 0, bytes_of(s.attachment_lists.attachments)},
        {next[buffer::tethers], 0, bytes_of(s.attachment_lists.tethers)},
        {next[buffer::limit_scales], kept_scales, bytes_of(limit_scales)},
        {next[buffer::positions], kept_bytes, bytes_of(s.model.positions, kept)},
        {next[buffer::residuals], kept_residual_bytes, bytes_of(s.model.residuals, kept)},
        {next[buffer::velocities], kept_bytes, bytes_of(s.model.velocities, kept)},
        {next[buffer::normals], kept_bytes, bytes_of(up)},
        {next[buffer::recovery_votes_a], kept_votes, bytes_of(no_votes)},
        {next[buffer::recovery_votes_b], kept_votes, bytes_of(no_votes)},
    };
    for (const Staged& item : staged)
        if (auto result = uploader.stage(item.destination, item.offset, item.bytes); !result)
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
    upload.contents_->staging = uploader.record();
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
