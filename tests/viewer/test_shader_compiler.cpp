// Shaders that are compiled at run time.
#include "samples/viewer/shader_compiler.hpp"
#include "support/test_folder.hpp"
#include "support/test_paths.hpp"

#include <doctest/doctest.h>

#include <cstdlib>
#include <vector>

namespace
{

namespace fs = std::filesystem;

constexpr uint32_t k_spirv_magic = 0x07230203;

bool has_compiler()
{
    const bool has = std::system("command -v glslangValidator >/dev/null 2>&1") == 0;
    if (!has)
        MESSAGE("skipped: no glslangValidator");
    return has;
}

} // namespace

TEST_CASE("shaders are compiled at run time, and errors name file and line, in includes, too")
{
    if (!has_compiler())
        return;
    const TestFolder folder;
    const fs::path good = tests::source("shaders/render/sky.frag");
    folder.write("part.glsl", "// a part\nfloat half_of(float x) { return 0.5 * y; }\n");
    const fs::path broken = folder.write("broken.frag", "#version 460\n"
                                                        "#extension GL_GOOGLE_include_directive : require\n"
                                                        "#include \"part.glsl\"\nvoid main() {}\n");
    const fs::path without_entry = folder.write("without.frag", "#version 460\nvoid mian() {}\n");
    const std::vector<fs::path> files{good, broken, folder / "nosuch.frag", without_entry};
    const auto compiled = viewer::compile_shaders(files, folder.path());
    REQUIRE(compiled);
    REQUIRE(compiled.value().size() == 4);
    CHECK(compiled.value()[0].errors.empty());
    REQUIRE(compiled.value()[0].spirv.size() > 5);
    CHECK(compiled.value()[0].spirv[0] == k_spirv_magic);
    CHECK(compiled.value()[1].spirv.empty());
    REQUIRE(!compiled.value()[1].errors.empty());
    CHECK(compiled.value()[1].errors[0] == (folder / "part.glsl").string() + ":2: 'y' : undeclared identifier");
    CHECK(compiled.value()[2].errors.size() == 1);
    REQUIRE(compiled.value()[3].errors.size() == 1);
    CHECK(compiled.value()[3].errors[0].starts_with(without_entry.string() + ": Linking"));
    CHECK(folder.entries() == 3);
}

TEST_CASE("a compiler that is missing is an error, and another name is tried")
{
    const std::vector<fs::path> files{tests::source("shaders/render/sky.frag")};
    const auto missing = viewer::compile_shaders(files, tests::source("shaders/render"), {"no_such_compiler"});
    REQUIRE(!missing);
    CHECK(missing.error().message == "no_such_compiler is not installed (or not in PATH)");
    if (!has_compiler())
        return;
    const auto second =
        viewer::compile_shaders(files, tests::source("shaders/render"), {"no_such_compiler", "glslangValidator"});
    REQUIRE(second);
    CHECK(second.value()[0].errors.empty());
}
