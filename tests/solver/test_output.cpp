// Outputs: copies of cloths in vertex buffers of the host's, in its layouts.
#include "support/close_to.hpp"
#include "support/cloth_harness.hpp"
#include "support/cloth_meshes.hpp"
#include "support/collider_scenes.hpp"

#include <cstring>
#include <utility>

namespace
{

using tests::flat_sheet;
using tests::reason;
using voile::engine::take;

constexpr float k_gap = -77; // what the host has where nothing is written
constexpr VkDeviceSize k_bytes = 64 << 10;

// A solver, and a vertex buffer of the host's that is full of gaps.
class Host : public tests::ClothHarness
{
public:
    explicit Host(const voile::SolverOptions& options = {.output = {.previous_positions = true}})
        : ClothHarness(options),
          vertices_(take(voile::gpu::create_buffer(
              context(), "host vertices", k_bytes,
              VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
              voile::Memory::device)))
    {
        clear();
    }

    void clear()
    {
        uint32_t word = 0;
        std::memcpy(&word, &k_gap, sizeof(word));
        run([&](VkCommandBuffer cmd) { context().fn.vkCmdFillBuffer(cmd, buffer(), 0, VK_WHOLE_SIZE, word); });
    }

    // A layout of the buffer.
    [[nodiscard]] voile::VertexLayout layout(VkDeviceSize offset, uint32_t stride) const
    {
        return {.buffer = buffer(), .size = k_bytes, .offset = offset, .stride = stride};
    }

    void write_outputs(std::initializer_list<voile::OutputId> outputs)
    {
        run([&](VkCommandBuffer cmd) { take(solver.record_outputs(cmd, outputs)); });
    }

    std::vector<float> words() { return read<float>(buffer(), k_bytes / sizeof(float)); }

    // Puts what an output should have written into `expected`.
    void expect(std::vector<float>& expected, voile::ClothId cloth, const voile::VertexLayout& layout)
    {
        const voile::VertexStreams streams = solver.vertices(cloth);
        const std::pair<std::optional<uint32_t>, VkBuffer> attributes[] = {
            {layout.position, streams.positions},
            {layout.normal, streams.normals},
            {layout.velocity, streams.velocities},
            {layout.previous_position, streams.previous_positions}};
        for (const auto& [offset, stream] : attributes)
        {
            if (!offset)
                continue;
            const auto values = read<glm::vec4>(stream, streams.vertices, streams.offset);
            for (size_t i = 0; i < values.size(); ++i)
                std::memcpy(expected.data() + (layout.offset + i * layout.stride + *offset) / sizeof(float), &values[i],
                            sizeof(glm::vec3));
        }
    }

    [[nodiscard]] VkBuffer buffer() const { return vertices_.handle(); }

private:
    voile::gpu::Buffer vertices_;
};

std::vector<float> gaps()
{
    return std::vector<float>(k_bytes / sizeof(float), k_gap);
}

} // namespace

TEST_CASE_FIXTURE(Host, "outputs write what is asked for at the host's offsets and strides, and nothing else")
{
    voile::GridCloth grid = flat_sheet(9, 0.5f, 1);
    grid.velocity = {1, 2, 3};
    const voile::ClothId sheet = take(solver.add_cloth(grid));
    const tests::ClothMesh shape = tests::jittered_sheet(7, 5);
    const voile::ClothId mesh = take(solver.add_cloth(shape.cloth()));

    voile::VertexLayout all = layout(4 * 97, 64); // 81 vertices, no multiple of an offset's alignment
    all.position = 4;
    all.normal = 16;
    all.velocity = 52;
    all.previous_position = 28;
    voile::VertexLayout tight = layout(8 << 10, 12);
    tight.position = 0;
    voile::VertexLayout last = layout(k_bytes - 34 * 20 - 16, 20); // 35 vertices, of the last one 16 bytes
    last.normal = 4;
    voile::VertexLayout normals = layout(16 << 10, 24);
    normals.normal = 0;
    voile::VertexLayout velocities = layout(16 << 10, 24); // beside the normals
    velocities.velocity = 12;
    const std::pair<voile::ClothId, voile::VertexLayout> wanted[] = {
        {sheet, all}, {sheet, tight}, {mesh, last}, {mesh, normals}, {mesh, velocities}};
    std::vector<voile::OutputId> outputs;
    for (const auto& [cloth, where] : wanted)
        outputs.push_back(take(solver.add_output(cloth, where)));

    run([&](VkCommandBuffer cmd) { take(solver.record_outputs(cmd, outputs)); });
    CHECK(words() == gaps()); // nothing is uploaded
    upload();
    step({}, 2);
    run([&](VkCommandBuffer cmd) { take(solver.record_outputs(cmd, outputs)); });
    auto expected = gaps();
    for (const auto& [cloth, where] : wanted)
        expect(expected, cloth, where);
    CHECK(words() == expected);
    clear();
    write_outputs({outputs[2]});
    expected = gaps();
    expect(expected, mesh, last);
    CHECK(words() == expected);
}

TEST_CASE_FIXTURE(Host, "outputs continue while buffers grow and other cloths come and go")
{
    voile::VertexLayout where = layout(0, 36);
    where.position = 0;
    where.normal = 12;
    where.previous_position = 24;
    const voile::ClothId sheet = take(solver.add_cloth(flat_sheet(9, 0.5f, 1)));
    upload();
    const voile::OutputId output = take(solver.add_output(sheet, where));
    const auto check = [&](std::initializer_list<voile::OutputId> outputs, voile::ClothId cloth)
    {
        clear();
        step({});
        write_outputs(outputs);
        auto expected = gaps();
        expect(expected, cloth, where);
        CHECK(words() == expected);
    };
    check({output}, sheet);
    const VkBuffer before = solver.vertices(sheet).positions;
    const voile::ClothId other = take(solver.add_cloth(flat_sheet(40, 0.5f, 2)));
    const voile::OutputId others = take(solver.add_output(other, where)); // before its upload
    check({output}, sheet);                                               // while an upload is due
    // In one submission: the copy, then an upload that replaces the buffers, then the copy again.
    voile::Upload kept;
    run(
        [&](VkCommandBuffer cmd)
        {
            take(solver.record_outputs(cmd, {output}));
            kept = take(solver.record_upload(cmd));
            take(solver.record_outputs(cmd, {output}));
        });
    CHECK(solver.vertices(sheet).positions != before);
    check({output}, sheet);
    check({others}, other);
    take(solver.set_enabled(sheet, false)); // it can still be drawn
    check({output}, sheet);
    take(solver.remove(sheet));
    check({others}, other);
    const voile::ClothId next = take(solver.add_cloth(flat_sheet(9, 0.5f, 3)));
    upload();
    check({take(solver.add_output(next, where))}, next);
    check({others}, other);
}

TEST_CASE_FIXTURE(Host, "a cloth may be removed while its outputs are recorded and pending")
{
    voile::VertexLayout where = layout(0, 12);
    where.position = 0;
    const voile::ClothId sheet = take(solver.add_cloth(flat_sheet(9, 0.5f, 1)));
    (void)take(solver.add_cloth(flat_sheet(5, 0.5f, 2)));
    upload();
    const voile::OutputId output = take(solver.add_output(sheet, where));
    auto expected = gaps();
    expect(expected, sheet, where);
    voile::Upload kept;
    run(
        [&](VkCommandBuffer cmd)
        {
            take(solver.record_outputs(cmd, {output}));
            take(solver.remove(sheet));
            (void)take(solver.add_cloth(flat_sheet(12, 0.5f, 2)));
            kept = take(solver.record_upload(cmd));
        });
    CHECK(words() == expected);
    run([&](VkCommandBuffer cmd) { CHECK(reason(solver.record_outputs(cmd, {output})) == "output 0 was removed"); });
}

TEST_CASE_FIXTURE(Host, "outputs that cannot be are refused, and ids that name none")
{
    voile::GridCloth grid = flat_sheet(3, 0.5f, 1);
    grid.name = "flag";
    const voile::ClothId sheet = take(solver.add_cloth(grid));
    const auto refused = [&](const auto& change)
    {
        voile::VertexLayout where = layout(0, 24);
        where.position = 0;
        change(where);
        return reason(solver.add_output(sheet, where));
    };
    const std::string flag = "output of cloth \"flag\": ";
    CHECK(refused([](auto&) {}) == "accepted");
    CHECK(refused([](auto& l) { l.buffer = VK_NULL_HANDLE; }) == flag + "buffer is null");
    CHECK(refused([](auto& l) { l.stride = 26; }) == flag + "stride is 26, must be a multiple of 4");
    CHECK(refused([](auto& l) { l.offset = 2; }) == flag + "offset is 2, must be a multiple of 4");
    CHECK(refused([](auto& l) { l.position = 3; }) == flag + "position is 3, must be a multiple of 4");
    CHECK(refused([](auto& l) { l.stride = 0; }) == flag + "position is 0, its 12 bytes exceed the stride of 0");
    CHECK(refused([](auto& l) { l.stride = 8; }) == flag + "position is 0, its 12 bytes exceed the stride of 8");
    CHECK(refused([](auto& l) { l.normal = 16; }) == flag + "normal is 16, its 12 bytes exceed the stride of 24");
    CHECK(refused([](auto& l) { l.velocity = UINT32_MAX - 3; }) ==
          flag + "velocity is 4294967292, its 12 bytes exceed the stride of 24");
    CHECK(refused([](auto& l) { l.normal = 8; }) == flag + "normal overlaps position");
    CHECK(refused([](auto& l) { l.position.reset(); }) == flag + "no attribute has an offset");
    // The last of 9 vertices ends 12 bytes after its start.
    CHECK(refused([](auto& l) { l.size = 8 * 24 + 12; }) == "accepted");
    CHECK(refused([](auto& l) { l.size = 8 * 24 + 11; }) ==
          flag + "9 vertices from offset 0 on take 204 bytes, the buffer has 203");
    CHECK(refused([](auto& l) { l.offset = k_bytes + 4; }).starts_with(flag + "9 vertices from offset 65540 on"));
    CHECK(refused([](auto& l) { l.offset = UINT64_MAX - 3; }).ends_with("the buffer has 65536"));
    CHECK(refused(
              [](auto& l)
              {
                  l.stride = UINT32_MAX - 3;
                  l.size = UINT64_MAX;
              })
              .find(" bytes, the device binds at most ") != std::string::npos);

    Host plain{voile::SolverOptions{}};
    const voile::ClothId other = take(plain.solver.add_cloth(grid));
    voile::VertexLayout where = plain.layout(0, 24);
    where.previous_position = 0;
    CHECK(reason(plain.solver.add_output(other, where)) ==
          flag + "previous_position needs OutputOptions::previous_positions");
    CHECK(reason(solver.add_output(voile::ClothId{}, where)) == "cloth: the id is a default-constructed one");

    where = layout(0, 12);
    where.position = 0;
    const voile::OutputId output = take(solver.add_output(sheet, where));
    CHECK(output != voile::OutputId{});
    take(solver.remove(output));
    const voile::OutputId next = take(solver.add_output(sheet, where));
    CHECK(next.index == output.index);
    CHECK(next != output);
    upload();
    const std::string removed = "output " + std::to_string(output.index) + " was removed";
    CHECK(reason(solver.remove(output)) == removed);
    CHECK(reason(solver.remove(voile::OutputId{})) == "output: the id is a default-constructed one");
    CHECK(reason(solver.remove(voile::OutputId{99})) == "output 99 does not exist");
    run([&](VkCommandBuffer cmd) { CHECK(reason(solver.record_outputs(cmd, {next, output})) == removed); });
    CHECK(words() == gaps()); // nothing was recorded
    take(solver.remove(sheet));
    CHECK(reason(solver.remove(next)) == "output " + std::to_string(next.index) + " was removed");
}

namespace
{

// A frame of a host whose vertices have position, normal, texture coordinates and previous position.
voile::Solver record_frame(const voile::Handles& handles, VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize bytes,
                           voile::Upload& upload)
{
    const voile::GridCloth grid{.columns = 20, .rows = 20};
    // docs/integration.md shows this:
    voile::Solver solver = take(voile::Solver::create(handles, {.output = {.previous_positions = true}}));
    const voile::ClothId sheet = take(solver.add_cloth(grid));
    // The engine's vertices have 44 bytes. The cloth's begin at the 1000th; their texture coordinates, bytes 24 to 31,
    // stay as they are.
    const voile::OutputId output = take(solver.add_output(sheet, {.buffer = buffer,
                                                                  .size = bytes,
                                                                  .offset = 1000 * 44,
                                                                  .stride = 44,
                                                                  .position = 0,
                                                                  .normal = 12,
                                                                  .previous_position = 32}));
    // Each frame:
    if (solver.needs_upload())
        upload = take(solver.record_upload(cmd));
    take(solver.record(cmd, {.duration = 1.f / 60}));
    take(solver.record_outputs(cmd, {output})); // then the host draws from its buffer: no barrier
    // Until here.
    return solver;
}

} // namespace

TEST_CASE_FIXTURE(Host, "the output of the guide is written")
{
    voile::Upload kept;
    std::optional<voile::Solver> guides;
    run([&](VkCommandBuffer cmd) { guides = record_frame(tests::test_handles(), cmd, buffer(), k_bytes, kept); });
    const auto written = words();
    CHECK(written[0] == k_gap);
    CHECK(written[size_t{11} * 1000 + 4] == tests::close_to(1, 0.01)); // the first vertex's normal
    for (size_t vertex = 1000; vertex < 1400; ++vertex)
    {
        CHECK(written[11 * vertex] != k_gap);
        CHECK(written[11 * vertex + 10] != k_gap);
        CHECK(written[11 * vertex + 6] == k_gap);
        CHECK(written[11 * vertex + 7] == k_gap);
    }
}
