// physics_report: runs every case at two resolutions and writes FOLDER/physics.md with plots in FOLDER/physics.
//
//   physics_report FOLDER [CASE ...]    with cases: runs only these, to standard output; FOLDER exists
//   physics_report --list               prints the names of all cases
#include "physics/plot.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string_view>

namespace
{

using physics::Measurement;

std::string text(const char* format, double value)
{
    char result[32];
    std::snprintf(result, sizeof(result), format, value);
    return result;
}

std::string exact_of(const Measurement& m)
{
    return !m.known   ? "not known"
           : m.band() ? text("%.4g", m.low) + " to " + text("%.4g", m.high)
                      : text("%.5g", m.exact);
}

std::string error_of(const Measurement& m)
{
    if (!m.known)
        return "";
    if (m.band())
        return m.error() == 0 ? "inside" : text("%.3g", m.error()) + " outside";
    return m.exact == 0 ? text("%.2g", m.error()) : text("%.2g", 100 * m.error()) + " %";
}

std::string target_of(const Measurement& m)
{
    const std::string value = !m.known       ? ""
                              : m.band()     ? "inside"
                              : m.exact == 0 ? text("%.2g", m.target)
                                             : text("%.3g", 100 * m.target) + " %";
    const std::string change = m.change > 0 ? "change at most " + text("%.3g", m.change) : "";
    return value.empty() || change.empty() ? value + change : value + ", " + change;
}

// Returns the number of missed targets.
long write_table(std::ostream& out, const physics::CaseResult& coarse, const physics::CaseResult& fine)
{
    long missed = 0;
    out << "| quantity | exact | coarse | error | fine | error | target of fine | |\n"
           "| --- | --- | --- | --- | --- | --- | --- "
           "| --- |\n";
    for (size_t i = 0; i < fine.measurements.size(); ++i)
    {
        const Measurement& c = coarse.measurements[i];
        const Measurement& f = fine.measurements[i];
        const bool met = f.good() && (f.change == 0 || std::abs(f.value - c.value) <= f.change);
        missed += met ? 0 : 1;
        out << "| " << f.quantity << " | " << exact_of(f) << " | " << text("%.5g", c.value) << " (" << c.resolution
            << ") | " << error_of(c) << " | " << text("%.5g", f.value) << " (" << f.resolution << ") | " << error_of(f)
            << " | " << target_of(f) << " | " << (met ? "met" : "**missed**") << " |\n";
    }
    out << "\n";
    if (!fine.remark.empty())
        out << fine.remark << "\n\n";
    return missed;
}

// Returns the number of missed targets.
long run_case(const physics::Case& entry, std::ostream& out, const std::filesystem::path& plots)
{
    const auto start = std::chrono::steady_clock::now();
    const physics::CaseResult coarse = entry.run(physics::Detail::coarse);
    const physics::CaseResult fine = entry.run(physics::Detail::fine);
    out << "## " << entry.name << "\n" << entry.setup << "\n\n";
    const long missed = write_table(out, coarse, fine);
    for (const physics::Plot& plot : fine.plots)
    {
        out << "![" << plot.title << "](physics/" << plot.file << ".svg)\n\n";
        if (!plots.empty() && !physics::write_svg(plot, plots))
            throw std::runtime_error("cannot write " + (plots / plot.file).string() + ".svg");
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::cerr << entry.name << ": " << text("%.1f", seconds) << " s\n";
    return missed;
}

const char* const k_head = R"(# Physics report

Written by `physics_report docs`; do not edit. Every case runs on the GPU at two resolutions and is compared with its exact
value. Statics are brought to rest by kinetic damping: the velocities are set to zero whenever the kinetic energy has passed
a peak, so that no drag affects the rest state. Velocity Verlet advances every case that does not name RK4.

Targets are for the fine resolution. The coarse one has targets of its own, which test_physics checks; its error may be
above the one in the table.

)";

int report(const std::filesystem::path& folder, const std::vector<std::string>& only)
{
    const std::vector<physics::Case>& cases = physics::all_cases();
    for (const std::string& name : only)
        if (std::none_of(cases.begin(), cases.end(), [&](const physics::Case& entry) { return entry.name == name; }))
            throw std::runtime_error("there is no case \"" + name + "\"; --list prints all");
    if (!std::filesystem::is_directory(folder))
        throw std::runtime_error("there is no folder " + folder.string());
    std::ostringstream out;
    const std::filesystem::path plots = only.empty() ? folder / "physics" : "";
    if (only.empty())
        std::filesystem::create_directories(plots);
    long missed = 0;
    for (const physics::Case& entry : cases)
        if (only.empty() || std::find(only.begin(), only.end(), entry.name) != only.end())
            missed += run_case(entry, only.empty() ? out : std::cout, plots);
    if (!only.empty())
        return 0;
    std::ofstream file(folder / "physics.md");
    file << k_head
         << (missed == 0 ? "All targets are met at the fine resolution. Remarks stand below the tables."
                         : std::to_string(missed) + " targets are missed at the fine resolution.")
         << "\n\n"
         << out.str();
    if (!file.flush())
        throw std::runtime_error("cannot write " + (folder / "physics.md").string());
    return 0;
}

} // namespace

int main(int argc, char** argv)
{
    if (argc == 2 && std::string_view(argv[1]) == "--list")
    {
        for (const physics::Case& entry : physics::all_cases())
            std::cout << entry.name << "\n";
        return 0;
    }
    const bool help = argc == 2 && std::string_view(argv[1]) == "--help";
    if (help || argc < 2 || argv[1][0] == '-')
    {
        (help ? std::cout : std::cerr) << "usage: physics_report FOLDER [CASE ...] | --list\n";
        return help ? 0 : 1;
    }
    try
    {
        return report(argv[1], std::vector<std::string>(argv + 2, argv + argc));
    }
    catch (const std::exception& e)
    {
        std::cerr << "physics_report: " << e.what() << "\n";
        return 1;
    }
}
