// What a solver gives to the host's renderer: vertex streams from which the host draws, and copies of them in vertex
// buffers of the host. Also how both are ordered with the host's commands.
#pragma once

#include "voile/vulkan_types.hpp"

#include <cstdint>
#include <optional>

namespace voile
{

// Stages and accesses as in VkMemoryBarrier2.
struct Scope
{
    VkPipelineStageFlags2 stages = 0;
    VkAccessFlags2 accesses = 0;
};

// How the host's own commands use the vertex streams and the buffers of outputs, other than by compute shaders and
// transfers. 0: none.
struct HostScopes
{
    Scope before; // stages that read before the solver writes; accesses only of stages that write
    Scope after;  // stages and accesses that read what the solver has written
};

// Optional contents of the vertex streams. With the defaults, nothing is allocated, recorded or copied for them.
struct OutputOptions
{
    // Keeps the positions before the last step, for motion vectors. Costs a copy of the positions per step.
    bool previous_positions = false;
    // Keeps the triangles of each cloth in an index buffer.
    bool indices = false;
    // Usages of the streams' buffers, added to those that they have: vertex, storage and indirect buffer, transfer
    // source and destination; index buffer for the indices. They are passed to vkCreateBuffer unchanged.
    // VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT gives VertexStreams::addresses. The device must be created with the
    // feature bufferDeviceAddress. A BufferAllocator of the host must allocate such buffers with
    // VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT. VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR needs
    // VK_KHR_acceleration_structure.
    VkBufferUsageFlags usage = 0;
};

// Device addresses of a cloth's first vertex in each stream, and of its first index. 0 for a stream that does not
// exist, and all 0 without VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT.
struct StreamAddresses
{
    VkDeviceAddress positions = 0;
    VkDeviceAddress velocities = 0;
    VkDeviceAddress normals = 0;
    VkDeviceAddress previous_positions = 0;
    VkDeviceAddress indices = 0;
    VkDeviceAddress intersections = 0;
};

// Where a cloth's vertices are in the solver's buffers. Valid until the next record_upload. Null handles, 0 vertices
// and 0 indices for a cloth that is not uploaded yet or does not exist.
struct VertexStreams
{
    VkBuffer positions{};  // vec4: x y z (m) and inverse mass (1/kg)
    VkBuffer velocities{}; // vec4: x y z (m/s); w: 1 if the vertex touches a collider, plus 2 if a tether, a
                           // max-distance constraint or a backstop limits it, plus 4 if a triangle or an edge around it
                           // touched a feature of a collider
    VkBuffer normals{};    // vec4: unit normal and 0
    // vec4: the positions before the last recorded step. After an upload of the cloth, after record_restore, and after
    // a step that begins with reset or teleport, they equal the positions, so the motion is 0. Null without
    // OutputOptions::previous_positions.
    VkBuffer previous_positions{};
    VkDeviceSize offset = 0; // bytes, of the first vertex, in each of them
    uint32_t vertices = 0;

    // uint32, three per triangle, relative to the cloth's first vertex, in the order of Solver::triangles. Null without
    // OutputOptions::indices.
    VkBuffer indices{};
    VkDeviceSize index_offset = 0; // bytes, of the first index
    uint32_t index_count = 0;

    // uint32, one per vertex, as of the last time that record_statistics counted intersections: 1 if an edge or a
    // triangle around the vertex intersects one of a cloth, plus 2 if it intersects a collider. 0 after an upload. Null
    // without SolverOptions::intersections.
    VkBuffer intersections{};
    VkDeviceSize intersection_offset = 0; // bytes, of the first vertex

    StreamAddresses addresses;
};

// A vertex buffer of the host, and where its vertices have the attributes that a cloth writes: three floats each.
// Attributes without an offset are not written.
struct VertexLayout
{
    VkBuffer buffer{};       // with VK_BUFFER_USAGE_STORAGE_BUFFER_BIT
    VkDeviceSize size = 0;   // bytes, of the buffer
    VkDeviceSize offset = 0; // bytes, of the cloth's first vertex; a multiple of 4
    uint32_t stride = 0;     // bytes from one vertex to the next; a multiple of 4
    // Bytes from the start of a vertex, multiples of 4; they must not overlap.
    std::optional<uint32_t> position{};          // m
    std::optional<uint32_t> normal{};            // of unit length
    std::optional<uint32_t> velocity{};          // m/s
    std::optional<uint32_t> previous_position{}; // m; needs OutputOptions::previous_positions
};

} // namespace voile
