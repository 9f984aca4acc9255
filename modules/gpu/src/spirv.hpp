// Numbers of SPIR-V (specification, sections 2.3 and 3) that shader_interface.cpp and texel_reads.cpp need.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace voile::gpu::spirv
{

enum Opcode : uint32_t
{
    k_name = 5,
    k_extended_instruction = 12,
    k_entry_point = 15,
    k_execution_mode = 16,
    k_capability = 17,
    k_type_bool = 20,
    k_type_int = 21,
    k_type_float = 22,
    k_type_vector = 23,
    k_type_matrix = 24,
    k_type_image = 25,
    k_type_array = 28,
    k_type_runtime_array = 29,
    k_type_struct = 30,
    k_type_pointer = 32,
    k_constant = 43,
    k_constant_composite = 44,
    k_spec_constant = 50,
    k_spec_constant_composite = 51,
    k_spec_constant_op = 52,
    k_function = 54,
    k_variable = 59,
    k_load = 61,
    k_access_chain = 65,
    k_in_bounds_access_chain = 66,
    k_array_length = 68,
    k_decorate = 71,
    k_member_decorate = 72,
    k_vector_extract_dynamic = 77,
    k_vector_shuffle = 79,
    k_composite_construct = 80,
    k_composite_extract = 81,
    k_copy_object = 83,
    k_image_fetch = 95,
    k_bitcast = 124,
    k_integer_add = 128,
    k_integer_subtract = 130,
    k_integer_multiply = 132,
    k_unsigned_divide = 134,
    k_signed_divide = 135,
    k_shift_right = 194,
    k_shift_left = 196,
    k_execution_mode_id = 331,
};

enum Decoration : uint32_t
{
    k_spec_id = 1,
    k_buffer_block = 3, // SPIR-V 1.0: a storage buffer, in the storage class of uniform buffers
    k_row_major = 4,
    k_array_stride = 6,
    k_matrix_stride = 7,
    k_built_in = 11,
    k_volatile = 21,
    k_coherent = 23,
    k_non_writable = 24,
    k_non_readable = 25,
    k_binding = 33,
    k_descriptor_set = 34,
    k_offset = 35,
};

enum StorageClass : uint32_t
{
    k_uniform_constant = 0,
    k_uniform = 2,
    k_workgroup = 4,
    k_push_constant = 9,
    k_storage_buffer = 12,
};

constexpr uint32_t k_compute_model = 5;
constexpr uint32_t k_local_size = 17;     // execution modes: numbers,
constexpr uint32_t k_local_size_id = 38;  // and ids of constants
constexpr uint32_t k_workgroup_size = 25; // of k_built_in

constexpr size_t k_header_words = 5;
constexpr size_t k_version_word = 1;
constexpr uint32_t k_version_1_4 = 0x10400;
constexpr size_t k_bound_word = 3; // of the header: all ids are smaller

// Calls visit(opcode, words), words with the instruction's first one, until it returns false or the code is not SPIR-V.
template <typename Visit>
void for_each_instruction(std::span<const uint32_t> code, Visit&& visit)
{
    for (size_t at = k_header_words; at < code.size();)
    {
        const uint32_t length = code[at] >> 16;
        if (length == 0 || at + length > code.size() || !visit(code[at] & 0xffff, code.subspan(at, length)))
            return; // the driver refuses what is not SPIR-V
        at += length;
    }
}

} // namespace voile::gpu::spirv
