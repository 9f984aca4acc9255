// Declarations of the solver's storage buffers, from shared/buffers.h.
#pragma once

#include "shared/bindings.h"

#include <span>

namespace voile
{

enum class BufferKind
{
    kept,    // allocated by uploads, copied over when it grows
    scratch, // allocated by uploads; nothing in it outlives one
    output,  // as kept, but only if the host asks for it
    solvers, // uploads leave it alone
    hosts,   // the host's own
    role,    // what a kernel calls one of the others
};

struct BufferDeclaration
{
    BufferKind kind = BufferKind::role;
    uint32_t number = 0;
    const char* name = nullptr;
    const char* entry = nullptr; // the type of its entries
    uint32_t entry_bytes = 0;
    const char* count = nullptr; // of entries, as it is written in buffers.h; null unless uploads allocate it
    const char* meaning = nullptr;
};

// In the order of buffers.h. Roles have the numbers from buffer::k_numbers on.
std::span<const BufferDeclaration> buffer_declarations();
// Null: no buffer or role has that number.
const BufferDeclaration* find_declaration(uint32_t number);

} // namespace voile
