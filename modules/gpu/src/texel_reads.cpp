#include "texel_reads.hpp"

#include "spirv.hpp"
#include "texel_buffers.hpp"

#include <algorithm>
#include <utility>

namespace voile::gpu
{

namespace
{

using namespace spirv;

// Where in a buffer a value is: `offset` bytes from texel `texel` (an id) on.
struct Place
{
    uint32_t type = 0;
    uint32_t matrix_stride = 0;
    uint32_t offset = 0;
    uint32_t texel = 0;
    uint32_t component = 0; // an id, of a vector's component; 0: all of `type`
};

class Rewriter
{
public:
    explicit Rewriter(std::span<const uint32_t> code)
        : code_(code), next_id_(code[k_bound_word]), found_(find_texel_buffers(code, declared_))
    {
    }

    TexelReads rewrite();

private:
    using Words = std::span<const uint32_t>;

    void write_functions();
    void write_declarations(std::vector<uint32_t>& to);
    void write_load(Words words);
    // Whether a declaration is one of a buffer, and does not suit its texels.
    [[nodiscard]] bool is_replaced(uint32_t opcode, Words words) const;
    // The place of a member, an element, a column or a component, by a constant and by an id.
    [[nodiscard]] Place inner(Place place, uint32_t index) const;
    Place inner_at(Place place, uint32_t id, uint32_t texel_bytes);
    uint32_t read(const Place& place, uint32_t texel_bytes);
    uint32_t read_vector(const Place& place, uint32_t texel_bytes);
    uint32_t fetch(uint32_t texel, uint32_t number);

    uint32_t append(std::vector<uint32_t>& to, uint32_t opcode, uint32_t type, Words operands);
    uint32_t emit(uint32_t opcode, uint32_t type, std::initializer_list<uint32_t> operands);
    // The type with these operands, declared if the shader has none.
    uint32_t type(uint32_t opcode, std::vector<uint32_t> operands);
    uint32_t unsigned_type(uint32_t components);
    uint32_t image_type();
    uint32_t constant(uint32_t value);
    // The variable of a buffer's texels; a new one if the storage buffer stays.
    void add_image(uint32_t variable, const TexelBuffer& buffer);
    void list_images(std::vector<uint32_t>& to, size_t words) const;

    Words code_;
    uint32_t next_id_ = 0;
    uint32_t next_number_ = 0; // of a binding
    Declarations declared_;
    TexelBuffers found_;
    std::array<uint32_t, 5> unsigned_types_{};   // by components
    std::map<uint32_t, uint32_t> new_constants_; // by value
    std::vector<uint32_t> decorations_;          // new ones
    std::vector<uint32_t> declarations_;
    std::vector<uint32_t> functions_;
    std::map<uint32_t, uint32_t> images_; // by variable of the storage buffer
    std::map<uint32_t, TexelBinding> bindings_;

    uint32_t image_ = 0;                   // of the load that is written
    std::map<uint32_t, uint32_t> fetched_; // its texels, by number from the first one on
};

uint32_t Rewriter::append(std::vector<uint32_t>& to, uint32_t opcode, uint32_t type, Words operands)
{
    const uint32_t id = next_id_++;
    to.push_back(static_cast<uint32_t>(3 + operands.size()) << 16 | opcode);
    to.push_back(type);
    to.push_back(id);
    to.insert(to.end(), operands.begin(), operands.end());
    return id;
}

uint32_t Rewriter::emit(uint32_t opcode, uint32_t type, std::initializer_list<uint32_t> operands)
{
    return append(functions_, opcode, type, Words(operands.begin(), operands.size()));
}

uint32_t Rewriter::type(uint32_t opcode, std::vector<uint32_t> operands)
{
    if (const uint32_t known = declared_.find_type(opcode, operands))
        return known;
    const uint32_t id = next_id_++;
    declarations_.push_back(static_cast<uint32_t>(2 + operands.size()) << 16 | opcode);
    declarations_.push_back(id);
    declarations_.insert(declarations_.end(), operands.begin(), operands.end());
    declared_.add_type(id, {opcode, std::move(operands)});
    return id;
}

uint32_t Rewriter::unsigned_type(uint32_t components)
{
    uint32_t& known = unsigned_types_[components];
    if (known == 0)
        known = components == 1 ? type(k_type_int, {8 * k_scalar_bytes, 0})
                                : type(k_type_vector, {unsigned_type(1), components});
    return known;
}

uint32_t Rewriter::constant(uint32_t value)
{
    const auto [found, is_new] = new_constants_.try_emplace(value, 0);
    if (is_new)
        found->second = append(declarations_, k_constant, unsigned_type(1), std::array{value});
    return found->second;
}

Place Rewriter::inner(Place place, uint32_t index) const
{
    const uint32_t outer = place.type;
    const DeclaredType& type = declared_.type(outer);
    switch (type.opcode)
    {
    case k_type_struct:
        place.offset += declared_.decoration(outer, index, k_offset).value_or(0);
        place.matrix_stride = declared_.decoration(outer, index, k_matrix_stride).value_or(0);
        place.type = type.operands[index];
        return place;
    case k_type_array:
        place.offset += index * declared_.decoration(outer, k_array_stride).value_or(0);
        break;
    case k_type_matrix:
        place.offset += index * place.matrix_stride;
        break;
    default: // a vector
        place.offset += index * k_scalar_bytes;
        break;
    }
    place.type = type.operands[0];
    return place;
}

Place Rewriter::inner_at(Place place, uint32_t id, uint32_t texel_bytes)
{
    if (const std::optional<uint32_t> index = declared_.constant(id))
        return inner(place, *index);
    const DeclaredType& type = declared_.type(place.type);
    if (type.opcode == k_type_vector)
    {
        place.component = id;
        return place;
    }
    const uint32_t stride = type.opcode == k_type_matrix ? place.matrix_stride
                                                         : declared_.decoration(place.type, k_array_stride).value_or(0);
    const uint32_t texels = emit(k_integer_multiply, unsigned_type(1), {id, constant(stride / texel_bytes)});
    place.texel = emit(k_integer_add, unsigned_type(1), {place.texel, texels});
    place.type = type.operands[0];
    return place;
}

// The texel `number` texels from `texel` on.
uint32_t Rewriter::fetch(uint32_t texel, uint32_t number)
{
    const auto [found, is_new] = fetched_.try_emplace(number, 0);
    if (is_new)
    {
        const uint32_t coordinate =
            number == 0 ? texel : emit(k_integer_add, unsigned_type(1), {texel, constant(number)});
        const uint32_t image = emit(k_load, image_type(), {image_});
        found->second = emit(k_image_fetch, unsigned_type(4), {image, coordinate});
    }
    return found->second;
}

uint32_t Rewriter::read_vector(const Place& place, uint32_t texel_bytes)
{
    const uint32_t count = declared_.components(place.type);
    const uint32_t first = place.offset % texel_bytes / k_scalar_bytes;
    const uint32_t texel = fetch(place.texel, place.offset / texel_bytes);
    uint32_t bits = texel;
    if (count == 1)
        bits = emit(k_composite_extract, unsigned_type(1), {texel, first});
    else if (count == 2)
        bits = emit(k_vector_shuffle, unsigned_type(2), {texel, texel, first, first + 1});
    else if (count == 3)
        bits = emit(k_vector_shuffle, unsigned_type(3), {texel, texel, first, first + 1, first + 2});
    return place.type == unsigned_type(count) ? bits : emit(k_bitcast, place.type, {bits});
}

uint32_t Rewriter::read(const Place& place, uint32_t texel_bytes)
{
    if (declared_.components(place.type) > 0)
        return read_vector(place, texel_bytes);
    const DeclaredType type = declared_.type(place.type);
    const size_t count = type.opcode == k_type_struct   ? type.operands.size()
                         : type.opcode == k_type_matrix ? type.operands[1]
                                                        : declared_.constant(type.operands[1]).value_or(0);
    std::vector<uint32_t> parts;
    for (uint32_t i = 0; i < count; ++i)
        parts.push_back(read(inner(place, i), texel_bytes));
    return append(functions_, k_composite_construct, place.type, parts);
}

void Rewriter::write_load(Words words)
{
    const Chain& chain = found_.chains.at(words[3]);
    const TexelBuffer& buffer = found_.buffers.at(chain.variable);
    image_ = images_.at(chain.variable);
    fetched_.clear();
    Place place{buffer.element, buffer.matrix_stride, buffer.first_byte, chain.indices[1], 0};
    if (const uint32_t texels = buffer.stride / buffer.texel_bytes; texels > 1)
        place.texel = emit(k_integer_multiply, unsigned_type(1), {place.texel, constant(texels)});
    for (size_t i = 2; i < chain.indices.size(); ++i)
        place = inner_at(place, chain.indices[i], buffer.texel_bytes);
    const uint32_t value = read(place, buffer.texel_bytes);
    const bool is_component = place.component != 0;
    functions_.push_back((is_component ? 5u : 4u) << 16 | (is_component ? k_vector_extract_dynamic : k_copy_object));
    functions_.insert(functions_.end(), {words[1], words[2], value});
    if (is_component)
        functions_.push_back(place.component);
}

// A buffer of which texels are fetched.
uint32_t Rewriter::image_type()
{
    constexpr uint32_t k_buffer = 5;
    constexpr uint32_t k_sampled = 1;
    return type(k_type_image, {unsigned_type(1), k_buffer, 0, 0, 0, k_sampled, 0});
}

void Rewriter::write_functions()
{
    bool in_function = false;
    for_each_instruction(code_,
                         [&](uint32_t opcode, Words words)
                         {
                             in_function |= opcode == k_function;
                             if (!in_function)
                                 return true;
                             const bool is_load = opcode == k_load && found_.chains.contains(words[3]);
                             const bool is_chain = (opcode == k_access_chain || opcode == k_in_bounds_access_chain) &&
                                                   found_.chains.contains(words[2]);
                             if (is_load)
                                 write_load(words);
                             else if (!is_chain)
                                 functions_.insert(functions_.end(), words.begin(), words.end());
                             return true;
                         });
}

bool Rewriter::is_replaced(uint32_t opcode, Words words) const
{
    const auto is_buffer = [&](uint32_t id)
    {
        const auto found = found_.buffers.find(id);
        return found != found_.buffers.end() && found->second.whole;
    };
    if (opcode == k_extended_instruction) // debug information
        return std::ranges::any_of(words.subspan(5), is_buffer);
    if (opcode == k_decorate)
        return is_buffer(words[1]) && words[2] != k_binding && words[2] != k_descriptor_set;
    return opcode == k_variable && is_buffer(words[2]);
}

void Rewriter::write_declarations(std::vector<uint32_t>& to)
{
    constexpr uint32_t k_sampled_buffer = 46;
    const uint32_t pointer = type(k_type_pointer, {k_uniform_constant, image_type()});
    bool has_capability = false;
    bool has_decorations = false;
    for_each_instruction(code_,
                         [&](uint32_t opcode, Words words)
                         {
                             if (opcode == k_function)
                                 return false;
                             if (!std::exchange(has_capability, true))
                                 to.insert(to.end(), {2u << 16 | k_capability, k_sampled_buffer});
                             if (opcode == k_decorate && !std::exchange(has_decorations, true))
                                 to.insert(to.end(), decorations_.begin(), decorations_.end());
                             if (is_replaced(opcode, words))
                                 return true;
                             to.insert(to.end(), words.begin(), words.end());
                             if (opcode == k_entry_point && code_[k_version_word] >= k_version_1_4)
                                 list_images(to, words.size());
                             return true;
                         });
    to.insert(to.end(), declarations_.begin(), declarations_.end());
    for (const auto& [variable, image] : images_)
        to.insert(to.end(), {4u << 16 | k_variable, pointer, image, k_uniform_constant});
}

// Since SPIR-V 1.4 the entry point, the last `words` words of `to`, names all variables.
void Rewriter::list_images(std::vector<uint32_t>& to, size_t words) const
{
    uint32_t& first = to[to.size() - words];
    uint32_t added = 0;
    for (const auto& [variable, image] : images_)
        added += image != variable ? 1 : 0;
    first += added << 16;
    for (const auto& [variable, image] : images_)
        if (image != variable)
            to.push_back(image);
}

void Rewriter::add_image(uint32_t variable, const TexelBuffer& buffer)
{
    TexelBinding& binding = bindings_[buffer.number];
    binding = {buffer.whole ? buffer.number : next_number_++, buffer.texel_bytes};
    images_[variable] = buffer.whole ? variable : next_id_++;
    if (!buffer.whole)
        for (const auto& [name, value] : {std::pair(k_binding, binding.number), std::pair(k_descriptor_set, 0u)})
            decorations_.insert(decorations_.end(), {4u << 16 | k_decorate, images_[variable], name, value});
}

TexelReads Rewriter::rewrite()
{
    if (found_.buffers.empty())
        return {};
    next_number_ = declared_.last_binding() + 1;
    for (const auto& [variable, buffer] : found_.buffers)
        add_image(variable, buffer);
    write_functions();
    TexelReads result;
    result.spirv.assign(code_.begin(), code_.begin() + k_header_words);
    write_declarations(result.spirv);
    result.spirv.insert(result.spirv.end(), functions_.begin(), functions_.end());
    result.spirv[k_bound_word] = next_id_;
    result.bindings = std::move(bindings_);
    return result;
}

} // namespace

TexelReads texel_reads(std::span<const uint32_t> spirv)
{
    return Rewriter(spirv).rewrite();
}

} // namespace voile::gpu
