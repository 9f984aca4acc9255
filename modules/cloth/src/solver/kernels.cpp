// Kernels: compilation with the solver's options.
#include "solver/kernels.hpp"

#include "colliders/specialization.hpp"

#include "geometry/parallel.hpp"
#include "shared/feature_layout.h"
#include "shared/step_layout.h"

#include "voile/solver.hpp"

#include "voile_cloth_shaders.hpp"

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace voile
{

namespace
{

struct Request
{
    gpu::Kernel* kernel;
    gpu::KernelDescription description;
};

// The module's own code, or the host's in its place.
std::span<const uint32_t> code_of(std::span<const uint32_t> own, const SolverOptions& options)
{
    for (const ShaderReplacement& replacement : options.shaders)
        for (const shaders::NamedShader& shader : shaders::k_all)
            if (shader.code->data() == own.data() && replacement.file == shader.file)
                return replacement.spirv;
    return own;
}

Result<void> check_replacements(const SolverOptions& options)
{
    for (const ShaderReplacement& replacement : options.shaders)
        if (std::ranges::none_of(shaders::k_all, [&](const auto& shader) { return replacement.file == shader.file; }))
            return Error{"SolverOptions: shaders: no shader is called \"" + std::string(replacement.file) + '"'};
    return {};
}

std::vector<Request> requests_of(Kernels& kernels, const SolverOptions& options, VkPhysicalDeviceType device)
{
    const uint32_t group = options.tuning.workgroup_size;
    const auto method = static_cast<uint32_t>(options.tuning.contact_method);
    const auto interleaved = static_cast<uint32_t>(options.tuning.mesh_layout);
    std::vector<Request> requests;
    const auto add = [&](gpu::Kernel& kernel, const char* name, std::span<const uint32_t> spirv,
                         const Specialization& specialization) {
        requests.push_back({&kernel, {name, code_of(spirv, options), specialization.values()}});
    };
    const Specialization plain{.workgroup_size = group};
    const Specialization with_lists{.workgroup_size = group, .interleaved = interleaved};
    const uint32_t parts = threads_per_vertex(options);
    const auto add_integrators = [&](gpu::Kernel& stage, gpu::Kernel& verlet, uint32_t threads)
    {
        const Specialization with{.workgroup_size = group * threads,
                                  .interleaved = interleaved,
                                  .force_threads = threads,
                                  .force_parts = parts};
        add(stage, "cloth rk4 stage", shaders::k_integrate_comp, with);
        add(verlet, "cloth verlet", shaders::k_verlet_comp, with);
    };
    add_integrators(kernels.stage, kernels.verlet, 1);
    if (options.tuning.sharing_vertices > 0)
        add_integrators(kernels.stage_shared, kernels.verlet_shared, VOILE_FORCE_PARTS);
    add(kernels.pins, "cloth pins", shaders::k_pin_comp, plain);
    add(kernels.attachments, "cloth attachments", shaders::k_attachments_comp, plain);
    add(kernels.tethers, "cloth tethers", shaders::k_tether_comp, plain);
    add(kernels.limit_coarse, "cloth wide strain limit", shaders::k_limit_coarse_comp,
        {.workgroup_size = group * parts, .force_threads = parts});
    add(kernels.limit_strain, "cloth strain limit", shaders::k_limit_strain_comp, with_lists);
    add(kernels.limit_spin, "cloth limit spin", shaders::k_limit_spin_comp, plain);
    add(kernels.limit_smooth, "cloth limit smooth", shaders::k_limit_smooth_comp, plain);
    add(kernels.limit_work, "cloth limit work", shaders::k_limit_work_comp,
        {.workgroup_size = group, .interleaved = interleaved, .force_parts = parts});
    add(kernels.limit_scale, "cloth limit scale", shaders::k_limit_scale_comp, plain);
    add(kernels.limit_guard, "cloth limit guard", shaders::k_limit_guard_comp, plain);
    add(kernels.edit, "cloth edit", shaders::k_edit_comp, plain);
    const auto add_contact =
        [&](gpu::Kernel& kernel, uint32_t move, uint32_t convex, uint32_t near_lists, uint32_t pairs)
    {
        add(kernel, "cloth contact", shaders::k_contact_comp,
            {.workgroup_size = group,
             .contact_method = method,
             .interleaved = interleaved,
             .colliders_move = move,
             .colliders_convex = convex,
             .near_lists = near_lists,
             .pairs = pairs});
    };
    add_contact(kernels.contact, 0, 0, 0, 0);
    add_contact(kernels.contact_convex, 0, 1, 0, 0);
    add_contact(kernels.contact_moving, 1, 1, 0, 0);
    add_contact(kernels.contact_many, 1, 1, 1, 0);
    add_contact(kernels.contact_pairs, 0, 0, 0, 1);
    add_contact(kernels.contact_pairs_convex, 0, 1, 0, 1);
    add_contact(kernels.contact_pairs_moving, 1, 1, 0, 1);
    add_contact(kernels.contact_pairs_many, 1, 1, 1, 1);
    add(kernels.find_tangles, "cloth find tangles", shaders::k_find_tangles_comp, plain);
    add(kernels.pair_means, "cloth pair means", shaders::k_pair_means_comp, plain);
    add(kernels.pair_clear, "cloth pair clear", shaders::k_pair_clear_comp,
        {.workgroup_size = group, .frame_of_one = is_cpu(device) ? 0 : 1});
    add(kernels.find_islands, "cloth find islands", shaders::k_find_islands_comp, plain);
    add(kernels.pair_sweeps, "cloth pair sweeps", shaders::k_pair_sweeps_comp, with_lists);
    add(kernels.pair_boxes, "cloth pair boxes", shaders::k_pair_boxes_comp, plain);
    add(kernels.find_candidates, "cloth find candidates", shaders::k_find_candidates_comp, plain);
    add(kernels.sift_candidates, "cloth sift candidates", shaders::k_sift_candidates_comp, plain);
    add(kernels.find_pairs, "cloth find pairs", shaders::k_find_pairs_comp, plain);
    add(kernels.match_pairs, "cloth match pairs", shaders::k_match_pairs_comp, plain);
    add(kernels.index_pairs, "cloth index pairs", shaders::k_index_pairs_comp, plain);
    add(kernels.meet_pairs, "cloth meet pairs", shaders::k_meet_pairs_comp, plain);
    add(kernels.respond_to_pairs, "cloth respond to pairs", shaders::k_respond_to_pairs_comp, plain);
    add(kernels.near_colliders, "cloth near colliders", shaders::k_find_near_colliders_comp, plain);
    const Specialization at_rest{.workgroup_size = group, .colliders_move = 0};
    const Specialization moving{.workgroup_size = group, .colliders_move = 1};
    const auto add_features =
        [&](gpu::Kernel& near, gpu::Kernel& test, gpu::Kernel& contact, gpu::Kernel& traversal, uint32_t move)
    {
        const Specialization with{.workgroup_size = group, .interleaved = interleaved, .colliders_move = move};
        Specialization traversing = with;
        traversing.fewer_rounds = is_cpu(device) ? 1 : 0;
        add(near, "cloth near features", shaders::k_find_near_features_comp, traversing);
        add(test, "cloth feature tests", shaders::k_test_features_comp, with);
        Specialization part = with;
        part.feature_part = is_cpu(device) ? VOILE_FEATURES_LISTED : VOILE_FEATURES_ALL;
        add(contact, "cloth feature contact", shaders::k_feature_contact_comp, part);
        part.feature_part = VOILE_FEATURES_TRAVERSED;
        if (is_cpu(device))
            add(traversal, "cloth feature traversal", shaders::k_feature_contact_comp, part);
    };
    add_features(kernels.near_features, kernels.test_features, kernels.feature_contact, kernels.traverse_features, 0);
    add_features(kernels.near_features_moving, kernels.test_features_moving, kernels.feature_contact_moving,
                 kernels.traverse_features_moving, 1);
    add(kernels.depenetrate, "cloth depenetrate", shaders::k_depenetrate_comp, at_rest);
    add(kernels.depenetrate_moving, "cloth depenetrate", shaders::k_depenetrate_comp, moving);
    add(kernels.deform, "cloth deform", shaders::k_deform_comp, plain);
    add(kernels.face_features, "cloth face features", shaders::k_face_features_comp, plain);
    add(kernels.find_reaches, "cloth reaches", shaders::k_find_reaches_comp, plain);
    add(kernels.find_restless, "cloth restless", shaders::k_find_restless_comp, plain);
    add(kernels.wake_cloths, "cloth wake", shaders::k_wake_cloths_comp, plain);
    add(kernels.list_awake_patches, "cloth awake patches", shaders::k_list_awake_patches_comp, plain);
    add(kernels.find_speeds, "cloth speeds", shaders::k_find_speeds_comp, plain);
    add(kernels.decide_sleep, "cloth sleep", shaders::k_decide_sleep_comp, plain);
    add(kernels.fall_asleep, "cloth fall asleep", shaders::k_fall_asleep_comp, plain);
    add(kernels.normals, "cloth normals", shaders::k_normals_comp, with_lists);
    add(kernels.output, "cloth output", shaders::k_output_comp, plain);
    if (options.intersections)
    {
        add(kernels.count_cloth_pairs, "cloth count cloth pairs", shaders::k_count_cloth_pairs_comp, plain);
        add(kernels.count_collider_pairs, "cloth count collider pairs", shaders::k_count_collider_pairs_comp, plain);
    }
    add(kernels.statistics, "cloth statistics", shaders::k_statistics_comp, with_lists);
    add(kernels.statistics_reduce, "cloth statistics reduce", shaders::k_statistics_reduce_comp, plain);
    return requests;
}

// Drivers take seconds to compile large kernels, so all threads take part, and the largest come first.
Result<void> create(const gpu::Context& context, std::vector<Request> requests)
{
    std::ranges::stable_sort(requests, std::greater(), [](const Request& r) { return r.description.spirv.size(); });
    std::vector<std::optional<Error>> errors(requests.size());
    parallel_for(requests.size(), 1,
                 [&](size_t i, size_t)
                 {
                     auto kernel = gpu::Kernel::create(context, requests[i].description);
                     if (kernel)
                         *requests[i].kernel = std::move(kernel.value());
                     else
                         errors[i] = kernel.error();
                 });
    for (const std::optional<Error>& error : errors)
        if (error)
            return *error;
    return {};
}

} // namespace

uint32_t most_storage_buffers()
{
    Kernels none;
    ptrdiff_t most = 0;
    for (const Request& request : requests_of(none, {.intersections = true}, VK_PHYSICAL_DEVICE_TYPE_OTHER))
        if (const auto shader = gpu::reflect(request.description))
            most = std::max(most, std::ranges::count(shader.value().bindings, false, &gpu::ShaderBinding::uniform));
    return static_cast<uint32_t>(most);
}

uint32_t threads_per_vertex(const SolverOptions& options)
{
    return options.tuning.sharing_vertices > 0 ? VOILE_FORCE_PARTS : 1;
}

Result<void> check_limits(const VkPhysicalDeviceLimits& limits, const SolverOptions& options)
{
    Kernels none;
    for (const Request& request : requests_of(none, options, VK_PHYSICAL_DEVICE_TYPE_OTHER))
        if (auto within = gpu::check_limits(limits, request.description); !within)
            return within;
    return {};
}

Result<Kernels> create_kernels(const gpu::Context& context, const SolverOptions& options)
{
    if (auto known = check_replacements(options); !known)
        return known.error();
    if (auto within = check_limits(context.limits, options); !within) // before any is compiled
        return within.error();
    Kernels kernels;
    if (auto created = create(context, requests_of(kernels, options, context.device_type)); !created)
        return created.error();
    auto refit = create_refit_kernels(context, k_refit_workgroup, code_of(shaders::k_refit_comp, options));
    if (!refit)
        return refit.error();
    kernels.refit = std::move(refit.value());
    return kernels;
}

} // namespace voile
