// Scene files that are no scene: bad JSON, truncated, very long or very large text. Each has a message of one line.
#include "viewer/scene_text.hpp"

#include "samples/viewer/scene_reader.hpp"

#include <doctest/doctest.h>

#include <chrono>
#include <string>

namespace
{

using namespace scene_text;

} // namespace

TEST_CASE("a syntax error has its line and column")
{
    CHECK(message("{\n  \"cloths\": [,]\n}").starts_with("dir/s.json:2:14: syntax error"));
    CHECK(message("{\"cloths\": [").starts_with("dir/s.json:1:13: syntax error"));
    CHECK(message("{} x").starts_with("dir/s.json:1:4: syntax error"));
    CHECK(message("{\"a\": nan}").starts_with("dir/s.json:1:"));
    CHECK(message("{\"a\": \"\xff\"}").starts_with("dir/s.json:1:8: syntax error"));
    CHECK(message(std::string(100000, '[')) == "dir/s.json:1: more than 64 levels of nesting");
    for (const char* text : {"{\n", "[", "\"", "{\"a\"", "\x01", "{\"a\": 1,}", "// c\n{}"})
        CHECK(message(text).find('\n') == std::string::npos);
}

TEST_CASE("the line of a number is its own, not that of the line end behind it")
{
    CHECK(message("{\n\"gravity\":\n3\n\n}") == "dir/s.json:3: gravity is a number; expected an array of 3 numbers");
    CHECK(message("{\n\"gravity\": [0, 0,\n\"x\"\n]}") == "dir/s.json:3: gravity[2] is a string; expected a number");
}

TEST_CASE("an empty text and another root are refused")
{
    CHECK(message("") == "dir/s.json: the file is empty");
    CHECK(message(" \n\t") == "dir/s.json: the file is empty");
    CHECK(message("[]") == "dir/s.json:1: the scene is an array; expected an object");
    CHECK(message("{}") == "dir/s.json:1: the scene has no \"cloths\"");
    CHECK(message("{\"cloths\": []}") == "dir/s.json:1: cloths is empty; a scene needs a cloth");
    CHECK(message("{\"cloths\": {}}") == "dir/s.json:1: cloths is an object; expected an array");
    CHECK(message("{\"cloths\": [null]}") == "dir/s.json:1: cloths[0] is null; expected an object");
}

TEST_CASE("a key that appears twice is refused")
{
    CHECK(message("{\"gravity\": [0, 0, 0],\n\"gravity\": [0, 1, 0]}") ==
          "dir/s.json:2: key \"gravity\" appears twice in the scene");
    CHECK(cloth_message("\"name\": \"a\",\n\"name\": \"b\"") ==
          "dir/s.json:2: key \"name\" appears twice in cloths[0]");
}

TEST_CASE("a scene truncated anywhere is refused in one line")
{
    const std::string whole = "{\"gravity\": [0, -9.81, 0], \"cloths\": [{" + k_grid + ", \"material\": \"silk\"}]}";
    REQUIRE(message(whole) == "accepted");
    for (size_t length = 0; length < whole.size(); ++length)
    {
        const std::string refused = message(whole.substr(0, length));
        INFO("cut to ", length, " bytes: ", refused);
        CHECK(refused.starts_with("dir/s.json:"));
        CHECK(refused.find('\n') == std::string::npos);
    }
}

TEST_CASE("words for numbers that are not finite are not JSON")
{
    for (const char* word : {"NaN", "nan", "Infinity", "-Infinity", "inf", "-inf", "+1", "1.", ".5", "0x10", "1e"})
    {
        const std::string refused = scene_message("\n\"gravity\": [0, " + std::string(word) + ", 0]");
        INFO(word, ": ", refused);
        CHECK(refused.starts_with("dir/s.json:2:"));
        CHECK(refused.find("syntax error") != std::string::npos);
    }
    CHECK(cloth_message("\"velocity\": [0, -1e999, 0]") ==
          "dir/s.json:1: number -1e999 is beyond the largest that can be held");
    CHECK(cloth_message("\"velocity\": [0, \"NaN\", 0]") ==
          "dir/s.json:1: cloths[0].velocity[1] is a string; expected a number");
    CHECK(cloth_message("\"velocity\": [0, null, 0]") ==
          "dir/s.json:1: cloths[0].velocity[1] is null; expected a number");
}

TEST_CASE("a message stays short however long the input is")
{
    const std::string monster(100000, 'm');
    CHECK(message("{\"" + monster).size() < 300);
    CHECK(scene_message("\"" + monster + "\": 1").size() < 300);
    CHECK(cloth_message("\"material\": \"" + monster + "\"").size() < 300);
    CHECK(cloth_message("\"pins\": [\"" + monster + "\"]").size() < 300);
    CHECK(scene_message("\"gravity\": [0, 1" + std::string(5000, '0') + ", 0]").size() < 300);
}

TEST_CASE("a zero byte does not end a scene")
{
    const std::string whole = "{\"cloths\": [{" + k_grid + "}]}\n";
    REQUIRE(message(whole) == "accepted");
    const std::string zero(1, '\0');
    CHECK(message(whole + zero + "garbage") == "dir/s.json:2:1: byte 61 is zero");
    CHECK(message(whole + zero) == "dir/s.json:2:1: byte 61 is zero");
    CHECK(message(zero + whole) == "dir/s.json:1:1: byte 0 is zero");
}

TEST_CASE("a scene of very many keys is read quickly")
{
    const auto start = std::chrono::steady_clock::now();
    std::string keys;
    for (int i = 0; i < 300000; ++i)
        keys += "\"k" + std::to_string(i) + "\": 0,";
    CHECK(message("{" + keys + "\"k7\": 0}") == "dir/s.json:1: key \"k7\" appears twice in the scene");
    CHECK(message("{" + keys + "\"cloths\": []}").starts_with("dir/s.json:1: unknown key \"k0\" in the scene"));
    std::string cloths;
    for (int i = 0; i < 20000; ++i)
        cloths += (i == 0 ? "{" : ",{") + k_grid + "}";
    CHECK(parse("{\"cloths\": [" + cloths + "]}").value().cloths.size() == 20000);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    CHECK(elapsed.count() < 10);
}
