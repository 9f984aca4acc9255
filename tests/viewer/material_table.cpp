// material_table docs/scenes.md: writes the tables of material parameters into the guide, between two marks.
// material_table --check docs/scenes.md: fails if they are out of date.
#include "voile/material_parameters.hpp"

#include <cstdio>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>
#include <string_view>

namespace
{

constexpr std::string_view k_begin = "<!-- materials: written by build/release/bin/material_table docs/scenes.md -->\n";
constexpr std::string_view k_end = "<!-- materials: end -->\n";

std::string replaced(std::string text, std::string_view from, std::string_view to)
{
    for (size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
    return text;
}

std::string number(float value)
{
    char buffer[32];
    (void)std::snprintf(buffer, sizeof(buffer), "%g", static_cast<double>(value));
    return replaced(replaced(buffer, "e+0", "e"), "e-0", "e-");
}

// As people write it: kg/m², N·m.
std::string unit_text(const char* unit)
{
    return replaced(replaced(replaced(unit, "^2", "²"), "N m", "N·m"), "N s", "N·s");
}

template <typename M>
std::string key_text(const voile::MaterialParameter<M>& parameter)
{
    std::string text = "`" + std::string(parameter.name) + "`";
    if (parameter.components().size() == 1)
        return text;
    text += " (a number, or [";
    for (const auto& component : parameter.components())
        text += (text.back() == '[' ? "" : ", ") + std::string(component.name);
    return text + "])";
}

template <typename M>
std::string default_text(const voile::MaterialParameter<M>& parameter)
{
    const float value = parameter.components()[0].member.get(M{});
    return parameter.rule.or_zero && value == 0 ? "none" : number(value);
}

template <typename M>
std::string row(const voile::MaterialParameter<M>& parameter)
{
    const voile::ParameterRule<M>& rule = parameter.rule;
    const std::string least =
        rule.least_name != nullptr ? "`" + std::string(rule.least_name) + "`" : number(parameter.min);
    return "| " + key_text(parameter) + " | " + unit_text(parameter.unit) + " | " + least + " .. " +
           number(parameter.max) + (rule.or_zero ? ", 0: none" : "") + " | " + default_text(parameter) + " | " +
           replaced(parameter.meaning, "|", "\\|") + " |\n";
}

std::string tables()
{
    const std::string head = " | unit | range | default | |\n| --- | --- | --- | --- | --- |\n";
    std::string text = "| fabric" + head;
    for (const auto& parameter : voile::k_fabric_parameters)
        text += row(parameter);
    text += "\n| raw" + head;
    for (const auto& parameter : voile::k_own_material_parameters)
        if (voile::find_parameter(voile::k_fabric_parameters, parameter.name) == nullptr)
            text += row(parameter);
    return text;
}

} // namespace

int main(int argc, char** argv)
{
    const bool check = argc == 3 && std::string_view(argv[1]) == "--check";
    if (argc != 2 && !check)
    {
        std::cerr << "usage: material_table [--check] docs/scenes.md\n";
        return 1;
    }
    const std::string path = argv[argc - 1];
    std::ifstream input(path);
    const std::string text{std::istreambuf_iterator<char>(input), {}};
    const size_t begin = text.find(k_begin);
    const size_t end = text.find(k_end);
    if (begin == std::string::npos || end == std::string::npos || end < begin)
    {
        std::cerr << path << ": the marks around the tables of materials are missing: " << k_begin;
        return 1;
    }
    const std::string written = text.substr(0, begin + k_begin.size()) + tables() + text.substr(end);
    if (written == text)
        return 0;
    if (check)
    {
        std::cerr << path << ": the tables of materials are out of date; write them with "
                  << "build/release/bin/material_table docs/scenes.md\n";
        return 1;
    }
    std::ofstream output(path);
    output << written;
    return output.flush() ? 0 : 1;
}
