#include "solver/buffer_declarations.hpp"

#include "shared/attachment_layout.h"
#include "shared/bvh_layout.h"
#include "shared/cloth_layout.h"
#include "shared/collider_layout.h"
#include "shared/contact_layout.h"
#include "shared/feature_layout.h"
#include "shared/padded_layout.h"
#include "shared/pair_layout.h"
#include "shared/sleep_layout.h"
#include "shared/statistics_layout.h"
#include "shared/step_layout.h"
#include "shared/strain_layout.h"

#include <algorithm>
#include <iterator>

namespace voile
{

namespace shared
{

namespace
{

constexpr BufferDeclaration k_declarations[] = {
#define VOILE_BUFFER(number, name, entry, count, meaning)                                                              \
    {BufferKind::kept, number, #name, #entry, sizeof(entry), #count, meaning},
#define VOILE_SCRATCH_BUFFER(number, name, entry, count, meaning)                                                      \
    {BufferKind::scratch, number, #name, #entry, sizeof(entry), #count, meaning},
#define VOILE_OUTPUT_BUFFER(number, name, entry, count, meaning)                                                       \
    {BufferKind::output, number, #name, #entry, sizeof(entry), #count, meaning},
#define VOILE_SOLVER_BUFFER(number, name, entry, meaning)                                                              \
    {BufferKind::solvers, number, #name, #entry, sizeof(entry), nullptr, meaning},
#define VOILE_HOST_BUFFER(number, name, entry, meaning)                                                                \
    {BufferKind::hosts, number, #name, #entry, sizeof(entry), nullptr, meaning},
#define VOILE_ROLE(number, name, entry, meaning)                                                                       \
    {BufferKind::role, number, #name, #entry, sizeof(entry), nullptr, meaning},
#include "shared/buffers.h"
};

static_assert(std::ranges::all_of(k_declarations,
                                  [](const BufferDeclaration& declared) {
                                      return std::ranges::count(k_declarations, declared.number,
                                                                &BufferDeclaration::number) == 1;
                                  }),
              "two declarations have the same number");
static_assert(std::ranges::all_of(k_declarations,
                                  [](const BufferDeclaration& declared) {
                                      return (declared.kind == BufferKind::role) ==
                                             (declared.number >= buffer::k_numbers);
                                  }),
              "roles have the numbers from buffer::k_numbers on");

} // namespace

} // namespace shared

std::span<const BufferDeclaration> buffer_declarations()
{
    return shared::k_declarations;
}

const BufferDeclaration* find_declaration(uint32_t number)
{
    const auto found = std::ranges::find(shared::k_declarations, number, &BufferDeclaration::number);
    return found != std::end(shared::k_declarations) ? &*found : nullptr;
}

} // namespace voile
