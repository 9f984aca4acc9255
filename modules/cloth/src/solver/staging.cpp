#include "solver/staging.hpp"

#include <algorithm>

namespace voile
{

Result<gpu::Buffer> Staging::write(const gpu::Context& context) const
{
    VkDeviceSize size = 0;
    for (const Piece& piece : pieces_)
        size += piece.bytes.size();
    auto staged = gpu::create_buffer(context, "cloth staging", size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, Memory::upload);
    if (!staged)
        return staged.error();
    auto end = staged.value().mapped().begin();
    for (const Piece& piece : pieces_)
        end = std::ranges::copy(piece.bytes, end).out;
    staged.value().flush();
    return staged;
}

void Staging::record(gpu::Recorder& recorder, VkBuffer staged, const DeviceState& device) const
{
    VkDeviceSize source = 0;
    for (const Piece& piece : pieces_)
    {
        recorder.copy(staged, device[piece.name].handle(), {source, piece.offset, piece.bytes.size()});
        source += piece.bytes.size();
    }
}

} // namespace voile
