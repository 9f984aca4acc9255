#include "results_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <fstream>

namespace bench
{

namespace
{

using Fields = std::vector<std::string>;

// RFC 4180, one record per line.
std::optional<Fields> split(const std::string& line)
{
    Fields fields(1);
    bool quoted = false;
    for (size_t i = 0; i < line.size(); ++i)
    {
        if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"')
            fields.back() += line[i++];
        else if (line[i] == '"')
            quoted = !quoted;
        else if (line[i] == ',' && !quoted)
            fields.emplace_back();
        else if (line[i] != '\r')
            fields.back() += line[i];
    }
    if (quoted)
        return std::nullopt;
    return fields;
}

std::optional<double> number(const std::string& text)
{
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
        return std::nullopt;
    return value;
}

// Where the columns are that are read.
struct Columns
{
    size_t count = 0;
    size_t device = 0;
    size_t name = 0;
    size_t substeps = 0;
    size_t median = 0;
    size_t p95 = 0;
    size_t record = 0;
};

voile::Result<Columns> find_columns(const Fields& header)
{
    Columns columns{.count = header.size()};
    const std::pair<const char*, size_t Columns::*> wanted[] = {{"device", &Columns::device},
                                                                {"case", &Columns::name},
                                                                {"substeps_per_frame", &Columns::substeps},
                                                                {"gpu_us_per_substep_median", &Columns::median},
                                                                {"gpu_us_per_substep_p95", &Columns::p95},
                                                                {"record_us_per_frame_median", &Columns::record}};
    for (const auto& [title, column] : wanted)
    {
        const auto found = std::ranges::find(header, title);
        if (found == header.end())
            return voile::Error{std::string("no column ") + title};
        columns.*column = static_cast<size_t>(found - header.begin());
    }
    return columns;
}

voile::Result<CaseResult> parse(const Fields& fields, const Columns& columns)
{
    if (fields.size() != columns.count)
        return voile::Error{std::to_string(fields.size()) + " fields instead of " + std::to_string(columns.count)};
    const std::optional<double> substeps = number(fields[columns.substeps]);
    const std::optional<double> median = number(fields[columns.median]);
    const std::optional<double> p95 = number(fields[columns.p95]);
    if (!substeps || !median || !p95 || !(*median > 0))
        return voile::Error{"case " + fields[columns.name] + " has no times"};
    return CaseResult{fields[columns.device],        fields[columns.name], *substeps, *median, *p95,
                      number(fields[columns.record])};
}

void add(std::vector<CaseResult>& results, const CaseResult& result)
{
    const auto earlier = std::ranges::find(results, result.name, &CaseResult::name);
    if (earlier == results.end())
        results.push_back(result);
    else
        *earlier = result;
}

const char* verdict(const Comparison& comparison)
{
    if (!comparison.a)
        return "in B alone";
    if (!comparison.b)
        return "in A alone";
    if (!comparison.is_beyond_noise())
        return "";
    return comparison.ratio() < 1 ? "faster" : "slower";
}

std::string formatted(const char* format, double value)
{
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), format, value);
    return text.data();
}

std::string microseconds(double value)
{
    return formatted(value < 100 ? "%.2f" : "%.0f", value);
}

std::string padded(const std::string& text, size_t width)
{
    return text.size() < width ? std::string(width - text.size(), ' ') + text : text;
}

// The first device of a side; a file is of one machine.
std::string device_of(const std::vector<Comparison>& comparisons, std::optional<CaseResult> Comparison::*side)
{
    for (const Comparison& comparison : comparisons)
        if (comparison.*side)
            return (comparison.*side)->device;
    return "no case";
}

} // namespace

voile::Result<std::vector<CaseResult>> read_results(const std::filesystem::path& path)
{
    std::ifstream file(path);
    std::string line;
    if (!std::getline(file, line))
        return voile::Error{path.string() + ": cannot be read, or is empty"};
    const auto at = [&](size_t number_of_line) { return path.string() + ":" + std::to_string(number_of_line) + ": "; };
    const std::optional<Fields> header = split(line);
    if (!header)
        return voile::Error{at(1) + "a quote is not closed"};
    const auto columns = find_columns(*header);
    if (!columns)
        return voile::Error{at(1) + columns.error().message};
    std::vector<CaseResult> results;
    for (size_t i = 2; std::getline(file, line); ++i)
    {
        if (line.empty() || line == "\r")
            continue;
        const std::optional<Fields> fields = split(line);
        if (!fields)
            return voile::Error{at(i) + "a quote is not closed"};
        const auto result = parse(*fields, columns.value());
        if (!result)
            return voile::Error{at(i) + result.error().message};
        add(results, result.value());
    }
    return results;
}

bool Comparison::is_beyond_noise() const
{
    constexpr double k_least = 0.01; // two runs of one program differ by as much
    const double change = std::max(ratio(), 1 / ratio()) - 1;
    return change > std::max({a->noise(), b->noise(), k_least});
}

std::vector<Comparison> compare(const std::vector<CaseResult>& a, const std::vector<CaseResult>& b)
{
    const auto find = [](const std::vector<CaseResult>& results, const std::string& name)
    {
        const auto found = std::ranges::find(results, name, &CaseResult::name);
        return found == results.end() ? std::nullopt : std::optional(*found);
    };
    std::vector<Comparison> comparisons;
    comparisons.reserve(a.size() + b.size());
    for (const CaseResult& result : a)
        comparisons.push_back({result.name, result, find(b, result.name)});
    for (const CaseResult& result : b)
        if (!find(a, result.name))
            comparisons.push_back({result.name, std::nullopt, result});
    return comparisons;
}

std::string comparison_table(const std::vector<Comparison>& comparisons)
{
    constexpr size_t k_name = 30;
    constexpr size_t k_number = 11;
    std::string text =
        "A  " + device_of(comparisons, &Comparison::a) + "\nB  " + device_of(comparisons, &Comparison::b) + "\n\n";
    const auto add_row = [&](const std::string& name, const std::string& a, const std::string& b,
                             const std::string& ratio, const char* change)
    {
        std::string line = name + std::string(name.size() < k_name ? k_name - name.size() : 1, ' ') +
                           padded(a, k_number) + padded(b, k_number) + padded(ratio, k_number) + "  " + change;
        line.resize(line.find_last_not_of(' ') + 1);
        text += line + '\n';
    };
    add_row("case, us per substep", "A", "B", "B / A", "beyond noise");
    for (const Comparison& c : comparisons)
        add_row(c.name, c.a ? microseconds(c.a->median) : "-", c.b ? microseconds(c.b->median) : "-",
                c.a && c.b ? formatted("%.4g", c.ratio()) : "-", verdict(c));
    return text;
}

} // namespace bench
