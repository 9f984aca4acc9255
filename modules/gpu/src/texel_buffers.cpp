#include "texel_buffers.hpp"

#include "spirv.hpp"

#include <algorithm>

namespace voile::gpu
{

using namespace spirv;

void Declarations::read(uint32_t opcode, std::span<const uint32_t> words)
{
    switch (opcode)
    {
    case k_decorate:
        decorations_[words[1]][words[2]] = words.size() > 3 ? words[3] : 1;
        break;
    case k_member_decorate:
        member_decorations_[{words[1], words[2]}][words[3]] = words.size() > 4 ? words[4] : 1;
        break;
    case k_type_int:
    case k_type_float:
    case k_type_vector:
    case k_type_matrix:
    case k_type_image:
    case k_type_array:
    case k_type_runtime_array:
    case k_type_struct:
    case k_type_pointer:
        types_[words[1]] = {opcode, {words.begin() + 2, words.end()}};
        break;
    case k_constant:
        constants_[words[2]] = words[3];
        break;
    default:
        break;
    }
}

const DeclaredType& Declarations::type(uint32_t id) const
{
    static const DeclaredType none;
    const auto found = types_.find(id);
    return found != types_.end() ? found->second : none;
}

uint32_t Declarations::find_type(uint32_t opcode, std::span<const uint32_t> operands) const
{
    for (const auto& [id, known] : types_)
        if (known.opcode == opcode && std::ranges::equal(known.operands, operands))
            return id;
    return 0;
}

std::optional<uint32_t> Declarations::decoration(uint32_t id, uint32_t name) const
{
    const auto all = decorations_.find(id);
    if (all == decorations_.end() || !all->second.contains(name))
        return std::nullopt;
    return all->second.at(name);
}

std::optional<uint32_t> Declarations::decoration(uint32_t type, uint32_t member, uint32_t name) const
{
    const auto all = member_decorations_.find({type, member});
    if (all == member_decorations_.end() || !all->second.contains(name))
        return std::nullopt;
    return all->second.at(name);
}

std::optional<uint32_t> Declarations::constant(uint32_t id) const
{
    const auto found = constants_.find(id);
    return found != constants_.end() ? std::optional(found->second) : std::nullopt;
}

uint32_t Declarations::components(uint32_t id) const
{
    const DeclaredType& declared = type(id);
    if (declared.opcode == k_type_vector)
        return components(declared.operands[0]) * declared.operands[1];
    const bool is_scalar = declared.opcode == k_type_int || declared.opcode == k_type_float;
    return is_scalar && declared.operands[0] == 8 * k_scalar_bytes ? 1 : 0;
}

namespace
{

constexpr uint32_t k_most_texel_bytes = 16;

// Whether texels of a size hold each scalar and vector of a type whole.
class Fit
{
public:
    Fit(const Declarations& declarations, uint32_t texel_bytes) : declarations_(declarations), bytes_(texel_bytes) {}

    [[nodiscard]] bool fits(uint32_t id, uint32_t offset, uint32_t matrix_stride) const;

private:
    [[nodiscard]] bool fits_members(uint32_t id, uint32_t offset) const;
    [[nodiscard]] bool divides(uint32_t stride) const { return stride > 0 && stride % bytes_ == 0; }

    const Declarations& declarations_;
    uint32_t bytes_ = 0;
};

bool Fit::fits(uint32_t id, uint32_t offset, uint32_t matrix_stride) const
{
    const DeclaredType& type = declarations_.type(id);
    switch (type.opcode)
    {
    case k_type_struct:
        return fits_members(id, offset);
    case k_type_array:
        return declarations_.constant(type.operands[1]) &&
               divides(declarations_.decoration(id, k_array_stride).value_or(0)) &&
               fits(type.operands[0], offset, matrix_stride);
    case k_type_matrix:
        return divides(matrix_stride) && fits(type.operands[0], offset, 0);
    default:
    {
        const uint32_t components = declarations_.components(id);
        return components > 0 && offset % bytes_ + components * k_scalar_bytes <= bytes_;
    }
    }
}

bool Fit::fits_members(uint32_t id, uint32_t offset) const
{
    const std::vector<uint32_t>& members = declarations_.type(id).operands;
    for (uint32_t i = 0; i < members.size(); ++i)
    {
        const std::optional<uint32_t> own = declarations_.decoration(id, i, k_offset);
        if (!own || declarations_.decoration(id, i, k_row_major) ||
            !fits(members[i], offset + *own, declarations_.decoration(id, i, k_matrix_stride).value_or(0)))
            return false;
    }
    return true;
}

// The buffer behind a variable, if its layout has texels.
std::optional<TexelBuffer> texel_buffer(const Declarations& declarations, uint32_t variable, uint32_t pointer)
{
    const uint32_t block = declarations.type(pointer).operands[1];
    const DeclaredType& members = declarations.type(block);
    if (members.opcode != k_type_struct || members.operands.size() != 1)
        return std::nullopt;
    const DeclaredType& array = declarations.type(members.operands[0]);
    const auto has = [&](Decoration name) { return declarations.decoration(block, 0, name).has_value(); };
    if (array.opcode != k_type_runtime_array || !has(k_non_writable) || has(k_coherent) || has(k_volatile) ||
        has(k_row_major))
        return std::nullopt;
    TexelBuffer buffer;
    buffer.number = declarations.decoration(variable, k_binding).value_or(0);
    buffer.element = array.operands[0];
    buffer.stride = declarations.decoration(members.operands[0], k_array_stride).value_or(0);
    buffer.matrix_stride = declarations.decoration(block, 0, k_matrix_stride).value_or(0);
    for (uint32_t bytes = k_most_texel_bytes; bytes >= k_scalar_bytes; bytes /= 2)
        if (buffer.stride > 0 && buffer.stride % bytes == 0 &&
            Fit(declarations, bytes).fits(buffer.element, 0, buffer.matrix_stride))
        {
            buffer.texel_bytes = bytes;
            return buffer;
        }
    return std::nullopt;
}

// Follows an instruction of a function: finds chains, and drops buffers of which it takes anything but a loaded value.
void follow(TexelBuffers& found, uint32_t opcode, std::span<const uint32_t> words)
{
    const bool is_chain = opcode == k_access_chain || opcode == k_in_bounds_access_chain;
    const bool leads_on = is_chain && found.buffers.contains(words[3]) && words.size() >= 6;
    if (leads_on)
        found.chains[words[2]] = {words[3], {words.begin() + 4, words.end()}};
    const bool is_load = opcode == k_load && words.size() == 4 && found.chains.contains(words[3]);
    // A literal that equals an id by chance only leaves a buffer as it is.
    for (size_t i = 1; i < words.size(); ++i)
    {
        if ((leads_on && (i == 2 || i == 3)) || (is_load && i == 3))
            continue;
        found.buffers.erase(words[i]);
        if (const auto chain = found.chains.find(words[i]); chain != found.chains.end())
            found.buffers.erase(chain->second.variable);
    }
}

} // namespace

TexelBuffers find_texel_buffers(std::span<const uint32_t> code, Declarations& declarations)
{
    TexelBuffers found;
    bool in_function = false;
    for_each_instruction(code,
                         [&](uint32_t opcode, std::span<const uint32_t> words)
                         {
                             in_function |= opcode == k_function;
                             if (in_function)
                             {
                                 follow(found, opcode, words);
                                 return true;
                             }
                             declarations.read(opcode, words);
                             if (opcode == k_variable && words[3] == k_storage_buffer)
                                 if (const auto buffer = texel_buffer(declarations, words[2], words[1]))
                                     found.buffers[words[2]] = *buffer;
                             return true;
                         });
    std::erase_if(found.chains, [&](const auto& chain) { return !found.buffers.contains(chain.second.variable); });
    return found;
}

} // namespace voile::gpu
