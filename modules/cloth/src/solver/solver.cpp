// Solver: creation, additions, upload and queries. Recording is in record.cpp.
#include "voile/gpu/context.hpp"

#include "geometry/parallel.hpp"
#include "model/stability.hpp"
#include "solver/solver_state.hpp"

#include "shared/pair_layout.h"
#include "shared/statistics_layout.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace voile
{

namespace
{

// CPU devices have few, narrow subgroups. There several threads per vertex only repeat the work that they have in
// common.
uint32_t feature_threads(const gpu::Context& context, const Tuning& tuning)
{
    constexpr uint32_t k_many = 8; // a grid has six triangles around a vertex
    return tuning.feature_threads > 0 ? tuning.feature_threads
                                      : std::min(is_cpu(context.device_type) ? 1 : k_many, tuning.workgroup_size);
}

// Measured: bench/NOTES.md, "Forces that threads share".
uint32_t sharing_vertices(const gpu::Context& context, const SolverOptions& options)
{
    constexpr uint32_t k_few = 20000;
    const VkPhysicalDeviceLimits& limits = context.limits;
    const uint32_t threads = std::min(limits.maxComputeWorkGroupInvocations, limits.maxComputeWorkGroupSize[0]);
    const uint32_t group = options.tuning.workgroup_size;
    if (threads / VOILE_FORCE_PARTS < group || limits.maxComputeSharedMemorySize / VOILE_SHARED_FORCE_BYTES < group)
        return 0;
    if (options.tuning.sharing_vertices > 0)
        return options.tuning.sharing_vertices;
    return is_cpu(context.device_type) ? 0 : k_few;
}

// Measured: bench/NOTES.md, "Levels of substeps".
uint32_t dispatch_vertices(const gpu::Context& context, const SolverOptions& options)
{
    if (options.tuning.dispatch_vertices > 0)
        return options.tuning.dispatch_vertices;
    return is_cpu(context.device_type) ? 256 : 100000;
}

// One record per slot, all 0.
Result<gpu::Buffer> create_statistics(const gpu::Context& context, uint32_t slots)
{
    auto buffer =
        gpu::create_buffer(context, "cloth statistics", slots * sizeof(shared::StatisticsResult),
                           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, Memory::readback);
    if (buffer)
    {
        std::ranges::fill(buffer.value().mapped(), std::byte{0});
        buffer.value().flush();
    }
    return buffer;
}

} // namespace

bool checks_lifetime(const SolverOptions& options)
{
#ifdef NDEBUG
    constexpr bool k_debug = false;
#else
    constexpr bool k_debug = true;
#endif
    return options.lifetime_checks.value_or(k_debug);
}

Requirements requirements()
{
    Requirements result;
    result.api_version = VK_API_VERSION_1_2;
    result.device_extensions = {VK_KHR_SYNCHRONIZATION_2_EXTENSION_NAME};
    result.storage_buffers = most_storage_buffers();
    return result;
}

Upload::Upload() = default;
Upload::~Upload() = default;
Upload::Upload(Upload&&) noexcept = default;
Upload& Upload::operator=(Upload&&) noexcept = default;

Solver::Solver(std::unique_ptr<State> state) : state_(std::move(state)) {}
Solver::~Solver() = default;
Solver::Solver(Solver&&) noexcept = default;
Solver& Solver::operator=(Solver&&) noexcept = default;

Result<Solver> Solver::create(const Handles& handles, const SolverOptions& options)
{
    auto context = gpu::create_context(handles, wants_addresses(options.output));
    if (!context)
        return context.error();
    if (auto output = check_output(context.value(), options.output); !output)
        return output.error();
    if (!std::has_single_bit(options.tuning.workgroup_size))
        return Error{"Tuning: workgroup_size is " + std::to_string(options.tuning.workgroup_size) +
                     ", must be a power of two"};
    if (options.statistics_slots < 1 || options.statistics_slots > 16)
        return Error{"SolverOptions: statistics_slots is " + std::to_string(options.statistics_slots) +
                     ", must be 1 to 16"};
    if (!(options.tuning.contact_interval >= 0) || !std::isfinite(options.tuning.contact_interval))
        return Error{"Tuning: contact_interval is " + std::to_string(options.tuning.contact_interval) +
                     " s, must be at least 0 and finite"};
    if (options.tuning.feature_items.value_or(0) > VOILE_MOST_FEATURE_ITEMS)
        return Error{"Tuning: feature_items is " + std::to_string(*options.tuning.feature_items) +
                     ", must be at most " + std::to_string(VOILE_MOST_FEATURE_ITEMS)};
    if (options.tuning.pair_capacity < 1 || options.tuning.pair_capacity > VOILE_PAIRS)
        return Error{"Tuning: pair_capacity is " + std::to_string(options.tuning.pair_capacity) + ", not from 1 to " +
                     std::to_string(VOILE_PAIRS)};
    for (const auto& [name, threads] : {std::pair("feature_threads", options.tuning.feature_threads),
                                        std::pair("listing_threads", options.tuning.listing_threads)})
        if (threads > 0 && (!std::has_single_bit(threads) || threads > options.tuning.workgroup_size))
            return Error{"Tuning: " + std::string(name) + " is " + std::to_string(threads) +
                         ", must be 0 or a power of two up to workgroup_size"};
    if (auto method = check_enumerator("Tuning", "contact_method", static_cast<int>(options.tuning.contact_method),
                                       {"normal_ray", "nearest_point"});
        !method)
        return method.error();
    if (auto layout = check_enumerator("Tuning", "mesh_layout", static_cast<int>(options.tuning.mesh_layout),
                                       {"compact", "interleaved"});
        !layout)
        return layout.error();
    SolverOptions with = options;
    with.tuning.sharing_vertices = sharing_vertices(context.value(), options);
    with.tuning.feature_threads = feature_threads(context.value(), options.tuning);
    with.tuning.dispatch_vertices = dispatch_vertices(context.value(), options);
    const JobScope scope(options.jobs);
    auto kernels = create_kernels(context.value(), with);
    if (!kernels)
        return kernels.error();
    if (auto sets = check_sets(kernels.value()); !sets)
        return sets.error();
    auto state = std::make_unique<State>();
    state->context = context.value();
    state->options = with;
    state->options.shaders = {};
    state->model.limits = {options.tuning.workgroup_size, state->context.limits.maxComputeWorkGroupCount[0],
                           state->context.max_buffer_bytes};
    state->model.interleaved = options.tuning.mesh_layout == MeshLayout::interleaved;
    state->model.indices = options.output.indices;
    state->model.has_trees = options.intersections;
    state->model.untangles = options.untangling;
    state->collider_models.limits = state->model.limits;
    state->kernels = std::move(kernels.value());
    auto statistics = create_statistics(state->context, options.statistics_slots);
    if (!statistics)
        return statistics.error();
    state->statistics = std::move(statistics.value());
    if (options.command_reuse)
    {
        auto commands = StepCommands::create(state->context, *options.command_reuse, checks_lifetime(options));
        if (!commands)
            return commands.error();
        state->commands = std::make_unique<StepCommands>(std::move(commands.value()));
    }
    if (checks_lifetime(options))
    {
        auto check = LifetimeCheck::create(state->context, "voile::Solver");
        if (!check)
            return check.error();
        state->lifetime = std::move(check.value());
    }
    return Solver(std::move(state));
}

Result<ClothId> Solver::add_cloth(const GridCloth& grid)
{
    constexpr uint64_t k_bytes_per_vertex = VOILE_CANDIDATE_WORDS * sizeof(uint32_t); // the largest of its buffers
    const uint64_t bytes = state_->model.vertices.end_with(uint64_t{grid.columns} * grid.rows) * k_bytes_per_vertex;
    if (auto room = check_room(state_->model.limits, "cloth", grid.name,
                               std::to_string(grid.columns) + " x " + std::to_string(grid.rows) + " vertices", bytes);
        !room)
        return room.error();
    const uint64_t patches = count_grid_patches(grid.columns, grid.rows, state_->model.limits.workgroup_size);
    if (auto dispatch = state_->check_patches(grid.name, patches); !dispatch)
        return dispatch.error();
    auto result = state_->model.add(grid);
    state_->dirty |= result.has_value();
    return result;
}

Result<ClothId> Solver::add_cloth(const MeshCloth& mesh)
{
    const JobScope scope(state_->options.jobs);
    // About 12 springs of 16 bytes per vertex; a vertex of many triangles makes all lists of its workgroup longer.
    constexpr uint64_t k_bytes_per_vertex = 256;
    const uint64_t vertices = mesh.cooked ? mesh.cooked.vertices() : mesh.positions.size();
    const uint64_t bytes = state_->model.lists.end_with(k_list_vertices, vertices) * k_bytes_per_vertex;
    if (auto room = check_room(state_->model.limits, "cloth", mesh.name, std::to_string(vertices) + " vertices", bytes);
        !room)
        return room.error();
    const uint64_t patches = count_mesh_patches(vertices, state_->model.limits.workgroup_size);
    if (auto dispatch = state_->check_patches(mesh.name, patches); !dispatch)
        return dispatch.error();
    auto result = state_->model.add(mesh);
    state_->dirty |= result.has_value();
    return result;
}

Result<ColliderId> Solver::add_collider(const Collider& collider)
{
    const JobScope scope(state_->options.jobs);
    auto result = std::visit([&](const auto& shape) { return state_->collider_models.add(shape); }, collider);
    state_->dirty |= result.has_value();
    return result;
}

bool Solver::needs_upload() const
{
    return state_->dirty;
}

Statistics Solver::statistics(uint32_t slot) const
{
    Statistics result;
    if (slot >= state_->options.statistics_slots)
        return result;
    const gpu::Buffer& buffer = state_->statistics;
    buffer.invalidate();
    shared::StatisticsResult read{};
    std::memcpy(&read, buffer.mapped().data() + slot * sizeof(read), sizeof(read));
    const shared::StatisticsRecord& record = read.cloths;
    result.max_stretch = record.springs > 0 ? record.max_stretch : 0;
    result.mean_stretch = record.springs > 0 ? record.stretch_sum / static_cast<float>(record.springs) : 0;
    result.kinetic_energy = record.kinetic_energy;
    result.deepest_penetration = record.deepest_penetration;
    result.penetrating_vertices = record.penetrating_vertices;
    result.nan_vertices = record.nan_vertices;
    result.contacts = record.contacts;
    result.candidates = record.candidates;
    result.overflowing_vertices = record.overflowing_vertices;
    result.forced_pairs = record.forced_pairs;
    result.tangled_pairs = record.tangled_pairs;
    result.pair_searches = record.pair_searches;
    result.sleeping_cloths = record.sleeping_cloths;
    if (const shared::IntersectionCounters& pairs = read.intersections; pairs.counted != 0)
        result.intersections = {pairs.cloth_pairs, pairs.collider_pairs, pairs.uncertain_pairs};
    return result;
}

uint32_t Solver::stable_substeps(float duration, uint32_t max_substeps) const
{
    if (!validate(Step{.duration = duration}))
        return 0;
    uint32_t substeps = 1;
    for (const auto [index, cloth] : state_->model.cloths)
        if (cloth.enabled)
            substeps = std::max(substeps, voile::stable_substeps(cloth.record, static_cast<double>(duration)));
    return std::min(substeps, std::max(max_substeps, 1u));
}

Stability Solver::stability(ClothId cloth, const Step& step) const
{
    Stability result;
    const ClothModel* model = state_->find(cloth);
    if (model == nullptr || !validate(step))
        return result;
    const shared::ClothRecord& record = model->record;
    result.needed = voile::stable_substeps(record, static_cast<double>(step.duration));
    std::vector<SubstepNeed> needs;
    const SubstepPlan plan = state_->plan(step, needs, model);
    result.used = plan.substeps_of(plan.level_of(result.needed));
    const double substep = std::max(static_cast<double>(step.duration) / result.used,
                                    static_cast<double>(softening_of(*model, step, plan).softened_substep));
    const shared::StabilityScales scales = stability_scales(record, substep);
    result.stiffness_scale = static_cast<float>(scales.stiffness);
    result.damping_scale = static_cast<float>(scales.damping);
    result.load = static_cast<float>(scales.load);
    result.retardation = static_cast<float>(scales.retardation);
    return result;
}

std::vector<glm::uvec3> Solver::triangles(ClothId cloth) const
{
    const ClothModel* model = state_->find(cloth);
    return model != nullptr ? cloth_triangles(*model) : std::vector<glm::uvec3>{};
}

std::vector<glm::vec2> Solver::texture_coordinates(ClothId cloth) const
{
    const ClothModel* found = state_->find(cloth);
    if (found == nullptr)
        return {};
    const ClothModel& model = *found;
    if (model.mesh)
        return {model.mesh->texture_coordinates.begin(), model.mesh->texture_coordinates.end()};
    const shared::ClothRecord& record = model.record;
    std::vector<glm::vec2> result;
    result.reserve(record.vertices);
    for (uint32_t row = 0; row < record.rows; ++row)
        for (uint32_t column = 0; column < record.columns; ++column)
            result.emplace_back(static_cast<float>(column) * model.spacing.x,
                                static_cast<float>(row) * model.spacing.y);
    return result;
}

const std::string& Solver::name(ClothId cloth) const
{
    static const std::string k_none;
    const ClothModel* model = state_->find(cloth);
    return model != nullptr ? model->name : k_none;
}

MeshReport Solver::mesh_report(ClothId cloth) const
{
    const ClothModel* model = state_->find(cloth);
    return model != nullptr && model->mesh ? model->mesh->report : MeshReport{};
}

RecordReport Solver::record_report() const
{
    return state_->report;
}

const gpu::Context& Solver::context() const
{
    return state_->context;
}

uint32_t Solver::vertex_count() const
{
    uint32_t count = 0;
    for (const auto [index, cloth] : state_->model.cloths)
        count += cloth.record.vertices;
    return count;
}

uint32_t Solver::triangle_count() const
{
    uint64_t count = 0;
    for (const auto [index, cloth] : state_->model.cloths)
        count += count_triangles(cloth);
    return static_cast<uint32_t>(count);
}

} // namespace voile
