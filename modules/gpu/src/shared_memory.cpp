// The shared memory of a compute shader, read from its SPIR-V: the instructions that declare types, constants and
// variables are followed one by one, as they stand before their first use.
#include "shared_memory.hpp"

#include <algorithm>
#include <unordered_map>
#include <vector>

namespace voile::gpu
{

namespace
{

// Of the SPIR-V specification, section 3.49.
enum Opcode : uint32_t
{
    k_type_bool = 20,
    k_type_int = 21,
    k_type_float = 22,
    k_type_vector = 23,
    k_type_matrix = 24,
    k_type_array = 28,
    k_type_struct = 30,
    k_type_pointer = 32,
    k_constant = 43,
    k_constant_composite = 44,
    k_spec_constant = 50,
    k_spec_constant_composite = 51,
    k_spec_constant_op = 52,
    k_variable = 59,
    k_decorate = 71,
    k_composite_extract = 81,
    k_integer_add = 128,
    k_integer_subtract = 130,
    k_integer_multiply = 132,
    k_unsigned_divide = 134,
    k_signed_divide = 135,
    k_shift_right = 194,
    k_shift_left = 196,
};
constexpr uint32_t k_spec_id = 1;   // a decoration
constexpr uint32_t k_workgroup = 4; // a storage class
constexpr size_t k_header_words = 5;

struct Size
{
    uint64_t bytes = 0;
    uint64_t alignment = 1;
};

uint64_t aligned(uint64_t offset, uint64_t alignment)
{
    return (offset + alignment - 1) / alignment * alignment;
}

class SharedMemory
{
public:
    explicit SharedMemory(std::span<const uint32_t> specialization) : specialization_(specialization) {}

    void read(uint32_t opcode, std::span<const uint32_t> words); // without the instruction's first word
    [[nodiscard]] uint64_t bytes() const { return bytes_; }

private:
    uint32_t evaluate(uint32_t operation, std::span<const uint32_t> operands);
    void add_struct(std::span<const uint32_t> words);
    void add_array(uint32_t id, const Size& element, uint64_t count);

    std::span<const uint32_t> specialization_;
    std::unordered_map<uint32_t, Size> types_;      // of pointers: what they point to
    std::unordered_map<uint32_t, uint32_t> values_; // of whole numbers
    std::unordered_map<uint32_t, std::vector<uint32_t>> composites_;
    std::unordered_map<uint32_t, uint32_t> spec_ids_;
    uint64_t bytes_ = 0;
};

uint32_t SharedMemory::evaluate(uint32_t operation, std::span<const uint32_t> operands)
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

void SharedMemory::add_struct(std::span<const uint32_t> words)
{
    Size whole;
    for (const uint32_t member : words.subspan(1))
    {
        const Size& size = types_[member];
        whole.bytes = aligned(whole.bytes, size.alignment) + size.bytes;
        whole.alignment = std::max(whole.alignment, size.alignment);
    }
    whole.bytes = aligned(whole.bytes, whole.alignment);
    types_[words[0]] = whole;
}

void SharedMemory::add_array(uint32_t id, const Size& element, uint64_t count)
{
    types_[id] = {count * aligned(element.bytes, element.alignment), element.alignment};
}

void SharedMemory::read(uint32_t opcode, std::span<const uint32_t> words)
{
    switch (opcode)
    {
    case k_decorate:
        if (words[1] == k_spec_id)
            spec_ids_[words[0]] = words[2];
        break;
    case k_type_bool:
        types_[words[0]] = {4, 4};
        break;
    case k_type_int:
    case k_type_float:
        types_[words[0]] = {words[1] / 8, words[1] / 8};
        break;
    case k_type_vector:
    {
        const Size component = types_[words[1]];
        types_[words[0]] = {words[2] * component.bytes, (words[2] == 2 ? 2 : 4) * component.bytes};
        break;
    }
    case k_type_matrix:
        add_array(words[0], types_[words[1]], words[2]);
        break;
    case k_type_array:
        add_array(words[0], types_[words[1]], values_[words[2]]);
        break;
    case k_type_struct:
        add_struct(words);
        break;
    case k_type_pointer:
        types_[words[0]] = types_[words[2]];
        break;
    case k_constant:
        values_[words[1]] = words[2];
        break;
    case k_spec_constant:
    {
        const auto id = spec_ids_.find(words[1]);
        const bool given = id != spec_ids_.end() && id->second < specialization_.size();
        values_[words[1]] = given ? specialization_[id->second] : words[2];
        break;
    }
    case k_constant_composite:
    case k_spec_constant_composite:
        composites_[words[1]].assign(words.begin() + 2, words.end());
        break;
    case k_spec_constant_op:
        values_[words[1]] = evaluate(words[2], words.subspan(3));
        break;
    case k_variable:
        if (words[2] == k_workgroup)
        {
            const Size size = types_[words[0]];
            bytes_ = aligned(bytes_, size.alignment) + size.bytes;
        }
        break;
    default:
        break;
    }
}

} // namespace

uint64_t shared_memory_bytes(std::span<const uint32_t> spirv, std::span<const uint32_t> specialization)
{
    SharedMemory memory(specialization);
    for (size_t at = k_header_words; at < spirv.size();)
    {
        const uint32_t length = spirv[at] >> 16;
        if (length == 0 || at + length > spirv.size())
            break; // no SPIR-V: the driver says so
        memory.read(spirv[at] & 0xffff, spirv.subspan(at + 1, length - 1));
        at += length;
    }
    return memory.bytes();
}

} // namespace voile::gpu
