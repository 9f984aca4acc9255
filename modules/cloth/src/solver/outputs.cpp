// Outputs: copies of a cloth's vertices into vertex buffers of the host's.
#include "solver/solver_state.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace voile
{

namespace
{

constexpr VkDeviceSize k_word = sizeof(float);
constexpr VkDeviceSize k_attribute_bytes = 3 * k_word;

// The attributes of a layout, with their names for messages.
struct Attribute
{
    const char* name;
    std::optional<uint32_t> offset;
};

std::array<Attribute, 4> attributes_of(const VertexLayout& layout)
{
    return {{{"position", layout.position},
             {"normal", layout.normal},
             {"velocity", layout.velocity},
             {"previous_position", layout.previous_position}}};
}

Result<void> check_multiple(const std::string& what, const char* name, VkDeviceSize bytes)
{
    if (bytes % k_word == 0)
        return {};
    return Error{what + name + " is " + std::to_string(bytes) + ", must be a multiple of 4"};
}

Result<void> check_attributes(const std::string& what, const VertexLayout& layout)
{
    const auto attributes = attributes_of(layout);
    if (std::ranges::none_of(attributes, [](const Attribute& a) { return a.offset.has_value(); }))
        return Error{what + "no attribute has an offset"};
    for (const Attribute& attribute : attributes)
    {
        if (!attribute.offset)
            continue;
        if (auto multiple = check_multiple(what, attribute.name, *attribute.offset); !multiple)
            return multiple;
        if (*attribute.offset + k_attribute_bytes > layout.stride)
            return Error{what + attribute.name + " is " + std::to_string(*attribute.offset) +
                         ", its 12 bytes exceed the stride of " + std::to_string(layout.stride)};
        for (const Attribute& other : attributes)
            if (&other < &attribute && other.offset && *other.offset < *attribute.offset + k_attribute_bytes &&
                *attribute.offset < *other.offset + k_attribute_bytes)
                return Error{what + attribute.name + " overlaps " + other.name};
    }
    return {};
}

// Bytes from the first vertex to the end of what is written.
VkDeviceSize written_bytes(const VertexLayout& layout, uint32_t vertices)
{
    uint32_t last = 0;
    for (const Attribute& attribute : attributes_of(layout))
        last = std::max(last, attribute.offset.value_or(0));
    return VkDeviceSize{vertices - 1} * layout.stride + last + k_attribute_bytes;
}

Result<void> check_layout(const Solver::State& solver, const ClothModel& cloth, const VertexLayout& layout)
{
    const std::string what = "output of " + subject("cloth", cloth.name) + ": ";
    if (layout.buffer == VK_NULL_HANDLE)
        return Error{what + "buffer is null"};
    if (auto multiple = check_multiple(what, "stride", layout.stride); !multiple)
        return multiple;
    if (auto multiple = check_multiple(what, "offset", layout.offset); !multiple)
        return multiple;
    if (auto attributes = check_attributes(what, layout); !attributes)
        return attributes;
    if (layout.previous_position && !solver.options.output.previous_positions)
        return Error{what + "previous_position needs OutputOptions::previous_positions"};
    const VkDeviceSize bytes = written_bytes(layout, cloth.record.vertices);
    if (layout.offset > layout.size || bytes > layout.size - layout.offset)
        return Error{what + std::to_string(cloth.record.vertices) + " vertices from offset " +
                     std::to_string(layout.offset) + " on take " + std::to_string(bytes) + " bytes, the buffer has " +
                     std::to_string(layout.size)};
    const VkPhysicalDeviceLimits& limits = solver.context.limits;
    if (bytes + limits.minStorageBufferOffsetAlignment > limits.maxStorageBufferRange)
        return Error{what + "its vertices take " + std::to_string(bytes) + " bytes, the device binds at most " +
                     std::to_string(limits.maxStorageBufferRange)};
    return {};
}

Output make_output(const Solver::State& solver, ClothId cloth, const VertexLayout& layout)
{
    const auto words = [](std::optional<uint32_t> offset)
    { return offset ? static_cast<uint32_t>(*offset / k_word) : VOILE_NO_ATTRIBUTE; };
    const shared::ClothRecord& record = solver.find(cloth)->record;
    const VkDeviceSize before = layout.offset % solver.context.limits.minStorageBufferOffsetAlignment;
    Output output;
    output.cloth = cloth;
    output.buffer = layout.buffer;
    output.offset = layout.offset - before;
    output.bytes = before + written_bytes(layout, record.vertices);
    output.push = {record.first_vertex,
                   record.vertices,
                   static_cast<uint32_t>(before / k_word),
                   static_cast<uint32_t>(layout.stride / k_word),
                   words(layout.position),
                   words(layout.normal),
                   words(layout.velocity),
                   words(layout.previous_position)};
    return output;
}

Result<OutputSet> write_set(const Solver::State& solver, const Output& output, BufferHandles handles)
{
    const gpu::Kernel& kernel = solver.kernels.output;
    handles[buffer::host_vertices] = output.buffer;
    OutputSet result;
    auto bound =
        bindings_of(describe_output(result.set, solver.kernels, solver.options.output.previous_positions), handles);
    if (!bound)
        return bound.error();
    for (gpu::BufferBinding& binding : bound.value())
        if (binding.number == binding::host_vertices)
            std::tie(binding.offset, binding.bytes) = std::pair(output.offset, output.bytes);
    auto pool = gpu::BindingPool::create(solver.context, 1, static_cast<uint32_t>(bound.value().size()));
    if (!pool)
        return pool.error();
    auto set = pool.value().bind(kernel, bound.value());
    if (!set)
        return set.error();
    result.pool = std::move(pool.value());
    result.set = set.value();
    return result;
}

} // namespace

Result<std::vector<OutputSet>> write_outputs(const Solver::State& solver, const Growth& growth)
{
    std::vector<OutputSet> sets;
    if (!growth.any)
        return sets;
    const BufferHandles handles = handles_after(solver.device ? &*solver.device : nullptr, growth.next);
    for (const auto [index, output] : solver.outputs)
    {
        auto set = write_set(solver, output, handles);
        if (!set)
            return set.error();
        sets.push_back(std::move(set.value()));
    }
    return sets;
}

void Solver::State::replace_outputs(std::vector<OutputSet> sets)
{
    if (sets.empty())
        return;
    size_t next = 0;
    for (auto [index, output] : outputs)
    {
        std::swap(output.set, sets[next]);
        replaced.sets.push_back(std::move(sets[next++].pool));
    }
}

void Solver::State::remove_outputs(ClothId cloth)
{
    for (auto [index, output] : outputs)
        if (output.cloth == cloth)
        {
            replaced.sets.push_back(std::move(output.set.pool));
            outputs.remove(outputs.id_at(index));
        }
}

Result<OutputId> Solver::add_output(ClothId cloth, const VertexLayout& layout)
{
    State& s = *state_;
    if (auto exists = s.check(cloth); !exists)
        return exists.error();
    if (auto valid = check_layout(s, *s.find(cloth), layout); !valid)
        return valid.error();
    Output output = make_output(s, cloth, layout);
    if (s.device)
    {
        auto set = write_set(s, output, handles_after(&*s.device, DeviceState{}));
        if (!set)
            return set.error();
        output.set = std::move(set.value());
    }
    return s.outputs.add(std::move(output));
}

Result<void> Solver::remove(OutputId output)
{
    if (auto exists = state_->outputs.check("output", output); !exists)
        return exists;
    state_->outputs.remove(output);
    return {};
}

Result<void> Solver::record_outputs(VkCommandBuffer cmd, std::span<const OutputId> outputs,
                                    gpu::Timestamps* timestamps) const
{
    const State& s = *state_;
    for (const OutputId id : outputs)
        if (auto exists = s.outputs.check("output", id); !exists)
            return exists;
    const auto uploaded = [&](OutputId id) { return s.find(s.outputs.find(id)->cloth)->uploaded; };
    if (std::ranges::none_of(outputs, uploaded))
        return {};
    gpu::Recorder recorder(s.context, cmd, timestamps);
    s.lifetime.begin(cmd);
    begin_scope(recorder, s.options);
    for (const OutputId id : outputs)
    {
        const Output& output = *s.outputs.find(id);
        if (uploaded(id))
            recorder.dispatch(s.kernels.output, output.set.set, output.push.vertices, s.options.tuning.workgroup_size,
                              output.push);
    }
    end_scope(recorder, s.options);
    s.lifetime.end(cmd);
    return {};
}

Result<void> Solver::record_outputs(VkCommandBuffer cmd, std::initializer_list<OutputId> outputs,
                                    gpu::Timestamps* timestamps) const
{
    return record_outputs(cmd, std::span(outputs.begin(), outputs.size()), timestamps);
}

} // namespace voile
