// Reading and writing files, and printable text.
#include "voile/engine/assets/file.hpp"

#include "support/test_folder.hpp"
#include "voile/engine/assets/atomic_file.hpp"
#include "voile/engine/assets/load_mesh.hpp"
#include "voile/engine/assets/words.hpp"

#include <doctest/doctest.h>

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>

namespace
{

namespace fs = std::filesystem;

std::string message(const fs::path& path, uint64_t most = voile::engine::k_largest_file)
{
    const auto text = voile::engine::read_file(path, most);
    return text ? "accepted" : text.error().message;
}

} // namespace

TEST_CASE("only regular files are read, and only up to the size limit")
{
    const TestFolder folder;
    const std::string fifo = (folder / "pipe.obj").string();
    REQUIRE(::mkfifo(fifo.c_str(), 0600) == 0);
    CHECK(message(fifo) == fifo + ": cannot read: not a regular file"); // at once, although there is no writer
    const fs::path endless = folder / "endless.ply";
    fs::create_symlink("/dev/zero", endless);
    CHECK(message(endless) == endless.string() + ": cannot read: not a regular file");
    CHECK(voile::engine::load_mesh(endless).error().message == message(endless));
    CHECK(voile::engine::load_mesh(fifo).error().message == message(fifo));

    const fs::path large = folder.write("large.obj", "v");
    fs::resize_file(large, uint64_t{1} << 40); // sparse
    CHECK(message(large) == large.string() + ": cannot read: larger than 4096 MiB");
    const fs::path small = folder.write("small.obj", std::string(3 << 20, 'x'));
    CHECK(message(small, 2 << 20) == small.string() + ": cannot read: larger than 2 MiB");
    CHECK(voile::engine::read_file(small, 3 << 20).value() == std::string(3 << 20, 'x'));
    fs::create_symlink(small, folder / "link.obj");
    CHECK(voile::engine::read_file(folder / "link.obj").value().size() == 3 << 20);
    CHECK(voile::engine::read_file(folder.write("empty", "")).value().empty());
    CHECK(voile::engine::read_file("/proc/self/status")
              .value()
              .starts_with("Name:")); // a size of 0, and yet it has bytes
}

TEST_CASE("text from a file becomes one printable line")
{
    CHECK(voile::gpu::printable("Gräfin \xe2\x82\xac \xf0\x9f\xa7\xb5") == "Gräfin \xe2\x82\xac \xf0\x9f\xa7\xb5");
    CHECK(voile::gpu::printable("\x1b[31mred\r\n\t\x7f") == "?[31mred????");
    CHECK(voile::gpu::printable(std::string("a\0b", 3)) == "a?b");
    CHECK(voile::gpu::printable("\xc2\x9b"
                                "31m \xc2\x85 \xc2\xa0") == "?31m ? \xc2\xa0"); // CSI and NEL of C1; no-break space
    CHECK(voile::gpu::printable("\x9b"
                                "31m") == "?31m");
    CHECK(voile::gpu::printable("a\xe2\x80\xaetxt\xe2\x80\xa8") == "a?txt?"); // right to left, end of line
    for (const char* no_utf8 : {"\xff", "\xc3", "\xe2\x82", "\xc0\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\x80"})
    {
        const std::string shown = voile::gpu::printable(no_utf8);
        CHECK(std::count(shown.begin(), shown.end(), '?') == static_cast<std::ptrdiff_t>(shown.size()));
    }
    CHECK(voile::gpu::printable(std::string(300000, 'x')) == std::string(80, 'x') + "...");
    CHECK(voile::gpu::printable("abc", 3) == "abc");
    CHECK(voile::gpu::printable("abcd", 3) == "abc...");
    CHECK(voile::gpu::printable("a\xe2\x82\xac", 3) == "a..."); // not inside a character
    CHECK(voile::engine::quoted_word('\x1b' + std::string(100, 'w')) == "'?" + std::string(39, 'w') + "...'");
    CHECK(voile::engine::path_text("dir/a\nb.obj") == "dir/a?b.obj");
    const std::string path = voile::engine::path_text(std::string(5000, 'd') + "/b.obj");
    CHECK(path.starts_with("...d"));
    CHECK(path.ends_with("/b.obj"));
    CHECK(path.size() == 243);
}

TEST_CASE("messages about a mesh show no raw bytes of the file")
{
    const TestFolder folder;
    const std::string odd = "\x1b[2J" + std::string(300000, 'e');
    const std::string header = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                               "property float z\nelement face 1\nproperty list uchar int vertex_index\nelement " +
                               odd + " 1\nproperty list uchar int " + odd + "\nend_header\n";
    const std::string body = "0 0 0\n0 0 1\n1 0 0\n3 0 1 2\n";
    for (const std::string& text :
         {header + body, header + body + "2 1\n", header + body + "1 1 " + odd + "\n", header + body + "0\n1\n",
          "ply\n" + odd, "ply\nformat " + odd + " 1.0\n", "ply\nformat ascii 1.0\nproperty " + odd + " x\n"})
    {
        const auto refused = voile::engine::load_mesh(folder.write("a\x1b.ply", text));
        REQUIRE_FALSE(refused);
        CHECK(refused.error().message.size() < 400);
        CHECK(refused.error().message == voile::gpu::printable(refused.error().message, 400));
    }
    for (const std::string& text : {"v " + odd + "\n", "v 0 0 0\nf " + odd + " 1 1\n"})
    {
        const auto refused = voile::engine::load_mesh(folder.write("a\x1b.obj", text));
        REQUIRE_FALSE(refused);
        CHECK(refused.error().message == voile::gpu::printable(refused.error().message, 400));
    }
}

TEST_CASE("a link to a pipe, as /dev/stdout may be, is written directly")
{
    int ends[2];
    REQUIRE(::pipe(ends) == 0);
    const fs::path link = "/proc/self/fd/" + std::to_string(ends[1]);
    REQUIRE(fs::is_symlink(link));
    REQUIRE(voile::engine::write_file(link, "through"));
    std::array<char, 16> text{};
    CHECK(::read(ends[0], text.data(), text.size()) == 7);
    CHECK(std::string(text.data()) == "through");
    ::close(ends[0]);
    ::close(ends[1]);
}

TEST_CASE("a file is written completely or not at all")
{
    const TestFolder folder;
    const fs::path path = folder.write("a.txt", "before");
    {
        auto file = voile::engine::AtomicFile::create(path);
        REQUIRE(file);
        file.value().write("half");
        CHECK(folder.entries() == 2);
        voile::engine::AtomicFile moved = std::move(file.value());
        CHECK(folder.entries() == 2);
    }
    CHECK(folder.entries() == 1);
    CHECK(folder.read("a.txt") == "before");
    REQUIRE(voile::engine::write_file(path, "after"));
    CHECK(folder.entries() == 1);
    CHECK(folder.read("a.txt") == "after");
}
