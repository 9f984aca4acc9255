#include "texel_buffers.hpp"

#include "spirv.hpp"

#include <algorithm>
#include <unordered_set>

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

uint32_t Declarations::last_binding() const
{
    uint32_t last = 0;
    for (const auto& [id, by_name] : decorations_)
        if (const auto number = by_name.find(k_binding); number != by_name.end())
            last = std::max(last, number->second);
    return last;
}

uint32_t Declarations::end_of(uint32_t id, uint32_t matrix_stride) const
{
    const DeclaredType& declared = type(id);
    const auto end_of_last = [&](uint32_t count, uint32_t stride)
    { return count > 0 ? (count - 1) * stride + end_of(declared.operands[0], matrix_stride) : 0; };
    switch (declared.opcode)
    {
    case k_type_struct:
    {
        uint32_t end = 0;
        for (uint32_t i = 0; i < declared.operands.size(); ++i)
            end = std::max(end, decoration(id, i, k_offset).value_or(0) +
                                    end_of(declared.operands[i], decoration(id, i, k_matrix_stride).value_or(0)));
        return end;
    }
    case k_type_array:
        return end_of_last(constant(declared.operands[1]).value_or(0), decoration(id, k_array_stride).value_or(0));
    case k_type_matrix:
        return end_of_last(declared.operands[1], matrix_stride);
    default:
        return components(id) * k_scalar_bytes;
    }
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

// The buffer behind a variable, if its layout has texels. A range that a host binds may end where the last element
// does, without the padding that the stride has, so texels divide both.
std::optional<TexelBuffer> texel_buffer(const Declarations& declarations, uint32_t variable, uint32_t pointer)
{
    const uint32_t block = declarations.type(pointer).operands[1];
    const DeclaredType& members = declarations.type(block);
    if (members.opcode != k_type_struct || members.operands.empty())
        return std::nullopt;
    TexelBuffer buffer;
    buffer.member = static_cast<uint32_t>(members.operands.size() - 1);
    const uint32_t array = members.operands.back();
    const auto has = [&](Decoration name)
    { return declarations.decoration(block, buffer.member, name) || declarations.decoration(variable, name); };
    if (declarations.type(array).opcode != k_type_runtime_array || has(k_coherent) || has(k_volatile) ||
        has(k_row_major))
        return std::nullopt;
    buffer.number = declarations.decoration(variable, k_binding).value_or(0);
    buffer.first_byte = declarations.decoration(block, buffer.member, k_offset).value_or(0);
    buffer.element = declarations.type(array).operands[0];
    buffer.stride = declarations.decoration(array, k_array_stride).value_or(0);
    buffer.matrix_stride = declarations.decoration(block, buffer.member, k_matrix_stride).value_or(0);
    const uint32_t end = declarations.end_of(buffer.element, buffer.matrix_stride);
    for (uint32_t bytes = k_most_texel_bytes; bytes >= k_scalar_bytes; bytes /= 2)
        if (buffer.stride > 0 && buffer.stride % bytes == 0 && buffer.first_byte % bytes == 0 && end % bytes == 0 &&
            Fit(declarations, bytes).fits(buffer.element, 0, buffer.matrix_stride))
        {
            buffer.texel_bytes = bytes;
            return buffer;
        }
    return std::nullopt;
}

// What functions do with buffers.
class Uses
{
public:
    explicit Uses(Declarations& declarations) : declarations_(declarations) {}

    void declare(uint32_t opcode, std::span<const uint32_t> words);
    void follow(uint32_t opcode, std::span<const uint32_t> words);
    TexelBuffers finish();

private:
    [[nodiscard]] bool is_block(uint32_t storage, uint32_t pointer) const;
    void find_narrow_integer(std::span<const uint32_t> words);
    [[nodiscard]] bool are_same(uint32_t index, uint32_t other) const;
    [[nodiscard]] bool overlap(const Chain& a, const Chain& b) const;
    [[nodiscard]] bool suits(const Chain& chain) const;

    Declarations& declarations_;
    TexelBuffers found_;
    std::unordered_set<uint32_t> narrow_; // ids of whole numbers that do not have 32 bits
};

bool Uses::is_block(uint32_t storage, uint32_t pointer) const
{
    return storage == k_storage_buffer ||
           (storage == k_uniform && declarations_.decoration(declarations_.type(pointer).operands[1], k_buffer_block));
}

void Uses::declare(uint32_t opcode, std::span<const uint32_t> words)
{
    declarations_.read(opcode, words);
    find_narrow_integer(words);
    if (opcode == k_variable && is_block(words[3], words[1]))
        if (const auto buffer = texel_buffer(declarations_, words[2], words[1]))
            found_.buffers[words[2]] = *buffer;
}

// An instruction with a result has its type and its id first. A literal that equals a type's id by chance only leaves a
// buffer as it is.
void Uses::find_narrow_integer(std::span<const uint32_t> words)
{
    if (words.size() < 3)
        return;
    const DeclaredType& type = declarations_.type(words[1]);
    if (type.opcode == k_type_int && type.operands[0] != 8 * k_scalar_bytes)
        narrow_.insert(words[2]);
}

// Literals may equal ids here, too: they only leave buffers as they are.
void Uses::follow(uint32_t opcode, std::span<const uint32_t> words)
{
    find_narrow_integer(words);
    const bool is_chain = opcode == k_access_chain || opcode == k_in_bounds_access_chain;
    const bool leads_on = is_chain && found_.buffers.contains(words[3]) && words.size() >= 6;
    if (leads_on)
        found_.chains[words[2]] = {words[3], {words.begin() + 4, words.end()}};
    for (size_t i = 1; i < words.size(); ++i)
    {
        if (leads_on && (i == 2 || i == 3))
            continue;
        if (const auto chain = found_.chains.find(words[i]); chain != found_.chains.end())
            chain->second.is_kept |= opcode != k_load || words.size() != 4 || i != 3;
        if (const auto buffer = found_.buffers.find(words[i]); buffer != found_.buffers.end())
        {
            if (opcode == k_array_length)
                buffer->second.whole = false;
            else
                found_.buffers.erase(buffer);
        }
    }
}

bool Uses::are_same(uint32_t index, uint32_t other) const
{
    const std::optional<uint32_t> a = declarations_.constant(index);
    const std::optional<uint32_t> b = declarations_.constant(other);
    return !a || !b || *a == *b;
}

// Whether what two chains into a buffer lead to may have bytes in common. Elements are taken for the same.
bool Uses::overlap(const Chain& a, const Chain& b) const
{
    if (!are_same(a.indices[0], b.indices[0]))
        return false;
    const size_t common = std::min(a.indices.size(), b.indices.size());
    for (size_t i = 2; i < common; ++i)
        if (!are_same(a.indices[i], b.indices[i]))
            return false;
    return true;
}

// Whether texels have what a chain leads to, and no thread writes it.
bool Uses::suits(const Chain& chain) const
{
    const TexelBuffer& buffer = found_.buffers.at(chain.variable);
    if (chain.is_kept || declarations_.constant(chain.indices[0]) != buffer.member ||
        std::ranges::any_of(chain.indices, [&](uint32_t id) { return narrow_.contains(id); }))
        return false;
    return std::ranges::none_of(
        found_.chains, [&](const auto& other)
        { return other.second.variable == chain.variable && other.second.is_kept && overlap(chain, other.second); });
}

TexelBuffers Uses::finish()
{
    std::erase_if(found_.chains, [&](const auto& chain) { return !found_.buffers.contains(chain.second.variable); });
    TexelBuffers result;
    for (const auto& [id, chain] : found_.chains)
        if (suits(chain))
            result.chains[id] = chain;
        else
            found_.buffers.at(chain.variable).whole = false;
    for (const auto& [id, chain] : result.chains)
        result.buffers[chain.variable] = found_.buffers.at(chain.variable);
    return result;
}

} // namespace

TexelBuffers find_texel_buffers(std::span<const uint32_t> code, Declarations& declarations)
{
    Uses uses(declarations);
    bool in_function = false;
    for_each_instruction(code,
                         [&](uint32_t opcode, std::span<const uint32_t> words)
                         {
                             in_function |= opcode == k_function;
                             if (in_function)
                                 uses.follow(opcode, words);
                             else
                                 uses.declare(opcode, words);
                             return true;
                         });
    return uses.finish();
}

} // namespace voile::gpu
