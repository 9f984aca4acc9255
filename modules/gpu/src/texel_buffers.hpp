// The storage buffers of a compute shader that can be read as texels (texel_reads.hpp), and the declarations that reads
// of them need.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

namespace voile::gpu
{

constexpr uint32_t k_scalar_bytes = 4;

struct DeclaredType
{
    uint32_t opcode = 0;
    std::vector<uint32_t> operands; // without the type's own id
};

// Types, decorations and constants of a shader, by id.
class Declarations
{
public:
    // An instruction in front of the first function.
    void read(uint32_t opcode, std::span<const uint32_t> words);

    [[nodiscard]] const DeclaredType& type(uint32_t id) const; // its opcode is 0 if none of those read has the id
    // The type with these operands; 0: there is none.
    [[nodiscard]] uint32_t find_type(uint32_t opcode, std::span<const uint32_t> operands) const;
    void add_type(uint32_t id, DeclaredType type) { types_[id] = std::move(type); }
    [[nodiscard]] std::optional<uint32_t> decoration(uint32_t id, uint32_t name) const;
    [[nodiscard]] std::optional<uint32_t> decoration(uint32_t type, uint32_t member, uint32_t name) const;
    [[nodiscard]] std::optional<uint32_t>
    constant(uint32_t id) const;                            // the value of one that specialization leaves alone
    [[nodiscard]] uint32_t components(uint32_t type) const; // of a scalar or vector of 32 bits; 0: it is none
    [[nodiscard]] uint32_t last_binding() const;            // the highest number
    // Bytes up to the end of the last scalar, of a type laid out by its decorations.
    [[nodiscard]] uint32_t end_of(uint32_t type, uint32_t matrix_stride) const;

private:
    using ByName = std::unordered_map<uint32_t, uint32_t>; // values of decorations; those without one have 1

    std::unordered_map<uint32_t, DeclaredType> types_;
    std::unordered_map<uint32_t, ByName> decorations_;
    std::map<std::array<uint32_t, 2>, ByName> member_decorations_; // by type and member
    std::unordered_map<uint32_t, uint32_t> constants_;
};

// A buffer that texels are read from.
struct TexelBuffer
{
    uint32_t number = 0;     // of the binding
    uint32_t member = 0;     // of the block: the array that it ends with
    uint32_t first_byte = 0; // of that array
    uint32_t element = 0;    // type
    uint32_t stride = 0;
    uint32_t matrix_stride = 0; // of elements that are matrices
    uint32_t texel_bytes = 0;
    bool whole = true; // all that functions do is to read texels
};

// What an access chain into a buffer leads to.
struct Chain
{
    uint32_t variable = 0;
    std::vector<uint32_t> indices; // ids: the block's member, the element, and on into it
    bool is_kept = false;          // something else than a load happens to what it leads to
};

struct TexelBuffers
{
    std::map<uint32_t, TexelBuffer> buffers;    // by variable
    std::unordered_map<uint32_t, Chain> chains; // whose loads are reads of texels, by id
};

// Also reads the declarations.
TexelBuffers find_texel_buffers(std::span<const uint32_t> code, Declarations& declarations);

} // namespace voile::gpu
