// reflect: the instructions before the first function are followed one by one, as they stand before their first use.
#include "voile/gpu/shader_interface.hpp"

#include "spirv.hpp"

#include <algorithm>
#include <unordered_map>
#include <utility>

namespace voile::gpu
{

namespace
{

using namespace spirv;

struct Size
{
    uint64_t bytes = 0;
    uint64_t alignment = 1;
};

uint64_t aligned(uint64_t offset, uint64_t alignment)
{
    return (offset + alignment - 1) / alignment * alignment;
}

using Decorations = std::unordered_map<uint32_t, uint32_t>; // by Decoration; those without a value have 1

struct Type
{
    uint32_t opcode = 0;
    std::vector<uint32_t> operands; // without the type's own id
    std::vector<Decorations> members;
};

class Reader
{
public:
    explicit Reader(std::span<const SpecializationConstant> specialization) : specialization_(specialization) {}

    void read(uint32_t opcode, std::span<const uint32_t> words); // without the instruction's first word
    Result<ShaderInterface> finish();

private:
    void read_workgroup();
    uint32_t evaluate(uint32_t operation, std::span<const uint32_t> operands);
    void add_variable(uint32_t pointer, uint32_t id, uint32_t storage);
    Result<void> add_binding(uint32_t pointer, uint32_t id, uint32_t storage);
    // By the rules of std430: what a type takes where nothing is decorated.
    Size size_of(uint32_t type);
    // By the type's own decorations: where it ends.
    uint64_t end_of(uint32_t type);
    uint64_t end_of_member(const Type& type, size_t member);
    [[nodiscard]] uint32_t value_of(uint32_t spec_id, uint32_t otherwise) const;

    [[nodiscard]] std::string name_of(uint32_t id) const;

    std::span<const SpecializationConstant> specialization_;
    std::vector<std::pair<uint32_t, std::span<const uint32_t>>> names_; // of the many, few are asked for
    std::unordered_map<uint32_t, Decorations> decorations_;
    std::unordered_map<uint32_t, Type> types_;
    std::unordered_map<uint32_t, uint32_t> values_; // of whole numbers
    std::unordered_map<uint32_t, std::vector<uint32_t>> composites_;
    ShaderInterface interface_;
    std::vector<uint32_t> workgroup_ids_; // of constants; empty: literal sizes
    bool has_compute_ = false;
    Result<void> status_;
};

std::string text_of(std::span<const uint32_t> words)
{
    std::string text;
    for (const uint32_t word : words)
        for (uint32_t shift = 0; shift < 32; shift += 8)
        {
            const auto letter = static_cast<char>(word >> shift & 0xff);
            if (letter == 0)
                return text;
            text += letter;
        }
    return text;
}

uint32_t Reader::evaluate(uint32_t operation, std::span<const uint32_t> operands)
{
    if (operation == k_composite_extract)
    {
        const std::vector<uint32_t>& members = composites_[operands[0]];
        return operands[1] < members.size() ? values_[members[operands[1]]] : 0;
    }
    const uint32_t a = values_[operands[0]];
    const uint32_t b = operands.size() > 1 ? values_[operands[1]] : 0;
    switch (operation)
    {
    case k_integer_add:
        return a + b;
    case k_integer_subtract:
        return a - b;
    case k_integer_multiply:
        return a * b;
    case k_unsigned_divide:
    case k_signed_divide:
        return b > 0 ? a / b : 0;
    case k_shift_right:
        return a >> b;
    case k_shift_left:
        return a << b;
    default:
        return 0; // no length of an array
    }
}

std::string Reader::name_of(uint32_t id) const
{
    const auto name = std::ranges::find(names_, id, &std::pair<uint32_t, std::span<const uint32_t>>::first);
    return name != names_.end() ? text_of(name->second) : std::string();
}

uint32_t Reader::value_of(uint32_t spec_id, uint32_t otherwise) const
{
    const auto given = std::ranges::find(specialization_, spec_id, &SpecializationConstant::id);
    return given != specialization_.end() ? given->value : otherwise;
}

Size Reader::size_of(uint32_t id)
{
    const Type& type = types_[id];
    const auto array = [&](uint64_t count)
    {
        const Size element = size_of(type.operands[0]);
        return Size{count * aligned(element.bytes, element.alignment), element.alignment};
    };
    switch (type.opcode)
    {
    case k_type_bool:
        return {4, 4};
    case k_type_int:
    case k_type_float:
        return {type.operands[0] / 8, type.operands[0] / 8};
    case k_type_pointer: // the address of a buffer
        return {8, 8};
    case k_type_vector:
    {
        const Size component = size_of(type.operands[0]);
        return {type.operands[1] * component.bytes, (type.operands[1] == 2 ? 2 : 4) * component.bytes};
    }
    case k_type_matrix:
        return array(type.operands[1]);
    case k_type_array:
        return array(values_[type.operands[1]]);
    case k_type_struct:
    {
        Size whole;
        for (const uint32_t member : type.operands)
        {
            const Size size = size_of(member);
            whole.bytes = aligned(whole.bytes, size.alignment) + size.bytes;
            whole.alignment = std::max(whole.alignment, size.alignment);
        }
        whole.bytes = aligned(whole.bytes, whole.alignment);
        return whole;
    }
    default:
        return {};
    }
}

uint64_t Reader::end_of_member(const Type& type, size_t member)
{
    Decorations decorations = member < type.members.size() ? type.members[member] : Decorations{};
    const Type& inner = types_[type.operands[member]];
    const bool matrix = inner.opcode == k_type_matrix;
    return decorations[k_offset] +
           (matrix ? uint64_t{inner.operands[1]} * decorations[k_matrix_stride] : end_of(type.operands[member]));
}

uint64_t Reader::end_of(uint32_t id)
{
    const Type& type = types_[id];
    if (type.opcode == k_type_array)
        return uint64_t{values_[type.operands[1]]} * decorations_[id][k_array_stride];
    if (type.opcode != k_type_struct)
        return size_of(id).bytes;
    uint64_t end = 0;
    for (size_t i = 0; i < type.operands.size(); ++i)
        end = std::max(end, end_of_member(type, i));
    return end;
}

Result<void> Reader::add_binding(uint32_t pointer, uint32_t id, uint32_t storage)
{
    Decorations& decorations = decorations_[id];
    const uint32_t number = decorations[k_binding];
    const uint32_t block_id = types_[pointer].operands[1];
    const Type& block = types_[block_id];
    const bool uniform = storage == k_uniform && !decorations_[block_id].contains(k_buffer_block);
    if ((storage != k_storage_buffer && storage != k_uniform) || decorations[k_descriptor_set] != 0)
        return Error{"binding " + std::to_string(number) + " of set " + std::to_string(decorations[k_descriptor_set]) +
                     " is no buffer of set 0"};
    if (block.opcode != k_type_struct)
        return Error{"binding " + std::to_string(number) + " is an array of buffers"};
    std::string block_name = name_of(block_id);
    ShaderBinding binding{number, block_name.empty() ? name_of(id) : std::move(block_name), false, false, 0, uniform};
    for (size_t i = 0; i < block.operands.size(); ++i)
    {
        Decorations member = i < block.members.size() ? block.members[i] : Decorations{};
        binding.read |= member[k_non_readable] == 0 && decorations[k_non_readable] == 0;
        binding.written |= !uniform && member[k_non_writable] == 0 && decorations[k_non_writable] == 0;
    }
    if (uniform)
        binding.stride = static_cast<uint32_t>(end_of(block_id));
    else if (!block.operands.empty() && types_[block.operands.back()].opcode == k_type_runtime_array)
        binding.stride = decorations_[block.operands.back()][k_array_stride];
    interface_.bindings.push_back(std::move(binding));
    return {};
}

void Reader::add_variable(uint32_t pointer, uint32_t id, uint32_t storage)
{
    const uint32_t type = types_[pointer].operands[1];
    if (storage == k_workgroup)
    {
        const Size size = size_of(type);
        interface_.shared_bytes = aligned(interface_.shared_bytes, size.alignment) + size.bytes;
    }
    else if (storage == k_push_constant)
        interface_.push_bytes = static_cast<uint32_t>(aligned(end_of(type), 4));
    else if (decorations_[id].contains(k_binding) && status_)
        status_ = add_binding(pointer, id, storage);
}

void Reader::read(uint32_t opcode, std::span<const uint32_t> words)
{
    switch (opcode)
    {
    case k_entry_point: // an execution model, the function, its name
        has_compute_ |= words[0] == k_compute_model && text_of(words.subspan(2)) == "main";
        break;
    case k_execution_mode: // of the entry point
        if (words[1] == k_local_size)
            std::ranges::copy(words.subspan(2, 3), interface_.workgroup.begin());
        break;
    case k_execution_mode_id: // since SPIR-V 1.2
        if (words[1] == k_local_size_id)
            workgroup_ids_.assign(words.begin() + 2, words.begin() + 5);
        break;
    case k_name:
        names_.emplace_back(words[0], words.subspan(1));
        break;
    case k_decorate:
        decorations_[words[0]][words[1]] = words.size() > 2 ? words[2] : 1;
        break;
    case k_member_decorate:
    {
        std::vector<Decorations>& members = types_[words[0]].members;
        members.resize(std::max<size_t>(members.size(), words[1] + 1));
        members[words[1]][words[2]] = words.size() > 3 ? words[3] : 1;
        break;
    }
    case k_type_bool:
    case k_type_int:
    case k_type_float:
    case k_type_vector:
    case k_type_matrix:
    case k_type_array:
    case k_type_runtime_array:
    case k_type_struct:
    case k_type_pointer: // a storage class, then what it points to
    {
        Type& type = types_[words[0]];
        type.opcode = opcode;
        type.operands.assign(words.begin() + 1, words.end());
        break;
    }
    case k_constant:
        values_[words[1]] = words[2];
        break;
    case k_spec_constant:
        values_[words[1]] = value_of(decorations_[words[1]][k_spec_id], words[2]);
        break;
    case k_constant_composite:
    case k_spec_constant_composite:
        composites_[words[1]].assign(words.begin() + 2, words.end());
        break;
    case k_spec_constant_op:
        values_[words[1]] = evaluate(words[2], words.subspan(3));
        break;
    case k_variable:
        add_variable(words[0], words[1], words[2]);
        break;
    default:
        break;
    }
}

// A constant with this decoration overrides the execution mode.
void Reader::read_workgroup()
{
    for (const auto& [id, sizes] : composites_)
        if (const auto built_in = decorations_[id].find(k_built_in);
            built_in != decorations_[id].end() && built_in->second == k_workgroup_size)
            workgroup_ids_ = sizes;
    for (size_t axis = 0; axis < workgroup_ids_.size(); ++axis)
        interface_.workgroup[axis] = values_[workgroup_ids_[axis]];
}

Result<ShaderInterface> Reader::finish()
{
    if (!status_)
        return status_.error();
    if (!has_compute_)
        return Error{"it has no compute entry point \"main\""};
    for (const auto& [id, decorations] : decorations_)
        if (const auto spec_id = decorations.find(k_spec_id); spec_id != decorations.end())
            interface_.constants.push_back({spec_id->second, name_of(id)});
    read_workgroup();
    std::ranges::sort(interface_.bindings, {}, &ShaderBinding::number);
    const auto twice = std::ranges::adjacent_find(interface_.bindings, {}, &ShaderBinding::number);
    if (twice != interface_.bindings.end())
        return Error{"binding " + std::to_string(twice->number) + " is declared twice"};
    std::ranges::sort(interface_.constants, {}, &ShaderConstant::id);
    return std::move(interface_);
}

} // namespace

Result<ShaderInterface> reflect(std::span<const uint32_t> code, std::span<const SpecializationConstant> specialization)
{
    Reader reader(specialization);
    spirv::for_each_instruction(code,
                                [&](uint32_t opcode, std::span<const uint32_t> words)
                                {
                                    if (opcode == k_function)
                                        return false;
                                    reader.read(opcode, words.subspan(1));
                                    return true;
                                });
    return reader.finish();
}

} // namespace voile::gpu
