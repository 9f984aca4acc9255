// cloth_bench: measures what the solver costs on a device, one line per case. Opens no window.
#include "add_mesh.hpp"
#include "cases.hpp"
#include "device_probe.hpp"
#include "frame_plot.hpp"
#include "measure.hpp"
#include "peers.hpp"
#include "record_cost.hpp"
#include "report.hpp"
#include "results_file.hpp"

#include "voile/engine/assets/atomic_file.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>

namespace
{

struct Options
{
    std::vector<std::string> names;
    bool list = false;
    bool list_devices = false;
    std::string device;
    std::string csv;
    std::string meshes;
    uint32_t repetitions = 0; // 0: by device
    uint32_t workgroup = voile::Tuning().workgroup_size;
    bool reuse = false;
    bool passes = false;
    std::vector<std::string> compared; // two files of results
    std::string plot;
    std::string results; // that the plot shows
    bool peers = false;
};

void declare(CLI::App& app, Options& options)
{
    constexpr uint32_t k_most = 100000;
    app.add_option("--case", options.names, "Measure this case only; repeatable")
        ->type_name("NAME")
        ->allow_extra_args(false);
    app.add_flag("--list", options.list, "List the cases and stop");
    app.add_flag("--list-devices", options.list_devices, "List the devices and stop");
    app.add_option("--device", options.device,
                   "Device by its index or a part of its name; default: a discrete GPU, "
                   "else any usable one")
        ->type_name("INDEX|NAME");
    app.add_option("--csv", options.csv, "Append one row per case to this file; keep one file per machine")
        ->type_name("FILE");
    app.add_option("--meshes", options.meshes,
                   "Folder of OBJ meshes; each makes three cases: real-NAME, real-NAME-turning, real-NAME-self")
        ->type_name("FOLDER");
    app.add_option("--repeat", options.repetitions, "Repetitions of each measurement; default: 100, on CPU devices 20")
        ->type_name("N")
        ->check(CLI::Range(1u, k_most));
    app.add_flag("--reuse", options.reuse, "Steps use commands again (SolverOptions::command_reuse)");
    app.add_option("--workgroup", options.workgroup, "Threads per workgroup, a power of two; default: the solver's")
        ->type_name("N");
    app.add_flag("--passes", options.passes, "Print the time of each pass before the row of a case of the solver");
}

// What needs no device.
void declare_results(CLI::App& app, Options& options)
{
    app.add_option("--compare", options.compared,
                   "Compare the cases of two files of --csv and stop: both medians, B / A, and whether they differ by "
                   "more than their repetitions do")
        ->type_name("A.csv B.csv")
        ->expected(2);
    CLI::Option* results =
        app.add_option("--results", options.results, "The file of --csv that --plot shows")->type_name("FILE");
    app.add_option("--plot", options.plot, "Draw the frames of the drape scene beside those of other solvers and stop")
        ->type_name("FILE.svg")
        ->needs(results);
    app.add_flag("--peers", options.peers, "Print the times of other solvers, and how they were taken, and stop");
}

struct Chosen
{
    std::vector<const bench::Case*> cases;
    std::vector<const bench::RefitCase*> refits;
    std::vector<const bench::DrapeCase*> drapes;
    std::vector<const bench::RealCase*> reals;
    std::vector<const bench::AddCase*> adds;
    bool costs = false;
    bool levels = false;
    bool garments = false;
    bool recording = false;
};

const bench::RealCase* find_real_case(std::span<const bench::RealCase> reals, const std::string& name)
{
    const auto found = std::ranges::find(reals, name, &bench::RealCase::name);
    return found == reals.end() ? nullptr : &*found;
}

// All named cases. Without names all, but the drape scene, heaps and meshes from files only on a GPU: a CPU device
// would take hours.
Chosen choose(const std::vector<std::string>& names, std::span<const bench::RealCase> reals, bool cpu)
{
    Chosen chosen;
    for (const std::string& name : names)
    {
        if (const bench::Case* item = bench::find_case(name))
            chosen.cases.push_back(item);
        else if (const bench::RefitCase* refit = bench::find_refit_case(name))
            chosen.refits.push_back(refit);
        else if (const bench::DrapeCase* drape = bench::find_drape_case(name))
            chosen.drapes.push_back(drape);
        else if (const bench::RealCase* real = find_real_case(reals, name))
            chosen.reals.push_back(real);
        else if (const bench::AddCase* add = bench::find_add_case(name))
            chosen.adds.push_back(add);
        else if (name == bench::k_cost_case)
            chosen.costs = true;
        else if (name == bench::k_levels_case)
            chosen.levels = true;
        else if (name == bench::k_garments_case)
            chosen.garments = true;
        else if (name == bench::k_record_case)
            chosen.recording = true;
        else
            throw voile::engine::StartupError("--case " + name + ": no such case; --list shows them");
    }
    if (!names.empty())
        return chosen;
    for (const bench::Case& item : bench::cases())
        if (!cpu || item.arrange == nullptr)
            chosen.cases.push_back(&item);
    for (const bench::RefitCase& item : bench::refit_cases())
        chosen.refits.push_back(&item);
    if (!cpu)
    {
        for (const bench::DrapeCase& item : bench::drape_cases())
            chosen.drapes.push_back(&item);
        for (const bench::RealCase& item : reals)
            chosen.reals.push_back(&item);
    }
    for (const bench::AddCase& item : bench::add_cases())
        chosen.adds.push_back(&item);
    chosen.costs = true;
    chosen.levels = true;
    chosen.garments = true;
    chosen.recording = true;
    return chosen;
}

void list_cases(std::span<const bench::RealCase> reals)
{
    for (const bench::Case& item : bench::cases())
        std::printf("%-28s %s\n", item.name, item.purpose);
    for (const bench::RefitCase& item : bench::refit_cases())
        std::printf("%-28s %s\n", item.name, item.purpose);
    for (const bench::DrapeCase& item : bench::drape_cases())
        std::printf("%-28s %s, 90 frames, %u x %u vertices, at most %u substeps\n", item.name,
                    bench::describe(item.subject), item.side, item.side, item.max_substeps);
    for (const bench::RealCase& item : reals)
        std::printf("%-28s cotton over %s%s\n", item.name.c_str(), item.file.string().c_str(),
                    item.turns            ? ", which turns by 90 degrees per second"
                    : item.self_collision ? ", with cloth that collides with itself"
                                          : "");
    for (const bench::AddCase& item : bench::add_cases())
        std::printf("%-28s adding a mesh collider: %s\n", item.name, item.purpose);
    std::printf("%-28s adding cloth meshes and cooked data; adding and removing beside much else\n",
                bench::k_cost_case);
    std::printf("%-28s a soft sheet beside a stiff one that needs more substeps\n", bench::k_levels_case);
    std::printf("%-28s characters of 20 capsules in capes, which stand and walk\n", bench::k_garments_case);
    std::printf("%-28s what recording costs the host, command by command\n", bench::k_record_case);
}

std::vector<bench::RealCase> real_cases_of(const Options& options)
{
    return options.meshes.empty() ? std::vector<bench::RealCase>() : bench::real_cases(options.meshes);
}

void list_devices()
{
    uint32_t index = 0;
    for (const voile::engine::DeviceInfo& device : voile::engine::list_devices())
        std::printf("%u  %s%s%s\n", index++, device.name.c_str(), device.unusable.empty() ? "" : ": ",
                    device.unusable.c_str());
}

void run(const Options& options)
{
    const std::vector<bench::RealCase> reals = real_cases_of(options);
    (void)choose(options.names, reals, false); // reports an unknown name before a device is opened
    std::optional<bench::CsvFile> csv;
    if (!options.csv.empty())
        csv = voile::engine::take(bench::CsvFile::open(options.csv));

    voile::engine::DeviceOptions wanted;
    wanted.device = options.device;
    const voile::engine::Device device(wanted);
    bench::TimedQueue queue(device);
    const bench::DeviceProbe probe = bench::probe_device(queue);
    const uint32_t repetitions = options.repetitions > 0 ? options.repetitions : device.is_cpu() ? 20 : 100;
    bench::print_device(device.info(), probe);
    const bench::Settings settings{options.workgroup, options.passes, options.reuse};
    const Chosen chosen = choose(options.names, reals, device.is_cpu());
    if (!chosen.cases.empty())
        bench::print_header();
    for (const bench::Case* item : chosen.cases)
    {
        const bench::Measurement measurement = bench::measure(queue, *item, repetitions, settings);
        bench::print_row(*item, measurement, probe);
        if (csv)
            voile::engine::take(csv->append(device.info(), probe, *item, measurement, repetitions));
    }
    if (!chosen.refits.empty())
        bench::print_refit_header();
    for (const bench::RefitCase* item : chosen.refits)
    {
        const bench::RefitMeasurement measurement = bench::measure_refit(queue, *item, repetitions);
        bench::print_refit_row(*item, measurement, probe);
        if (csv)
            voile::engine::take(csv->append(device.info(), probe, *item, measurement, repetitions));
    }
    if (!chosen.drapes.empty())
        bench::print_drape_header();
    for (const bench::DrapeCase* item : chosen.drapes)
    {
        const bench::DrapeMeasurement measurement = bench::measure_drape(queue, *item, settings);
        bench::print_drape_row(*item, measurement);
        if (csv)
            voile::engine::take(csv->append(device.info(), probe, *item, measurement));
    }
    if (!chosen.reals.empty())
        bench::print_real_header();
    for (const bench::RealCase* item : chosen.reals)
        bench::print_real_row(*item, bench::measure_real(queue, *item, settings));
    if (!chosen.adds.empty())
        bench::print_add_header();
    for (const bench::AddCase* item : chosen.adds)
        bench::print_add_row(*item, bench::measure_add(device, *item));
    if (chosen.costs)
        bench::print_costs(bench::measure_costs(queue));
    if (chosen.levels)
        bench::print_levels(bench::measure_levels(queue, repetitions));
    if (chosen.garments)
        bench::print_garments(bench::measure_garments(queue, settings));
    if (chosen.recording)
        bench::print_record_cost(bench::measure_record_cost(queue));
}

void compare_files(const std::vector<std::string>& paths)
{
    const auto a = voile::engine::take(bench::read_results(paths[0]));
    const auto b = voile::engine::take(bench::read_results(paths[1]));
    std::fputs(bench::comparison_table(bench::compare(a, b)).c_str(), stdout);
}

void write_plot(const std::string& path, const std::string& results)
{
    const std::string svg = voile::engine::take(bench::plot_frames(voile::engine::take(bench::read_results(results))));
    auto file = voile::engine::take(voile::engine::AtomicFile::create(path));
    file.write(svg);
    voile::engine::take(file.commit());
}

// CLI11's messages span several lines.
std::string first_line(const std::string& text)
{
    return text.substr(0, text.find('\n'));
}

} // namespace

int main(int argc, char** argv)
{
    Options options;
    CLI::App app("Measures the cloth solver on a device: GPU time, bytes moved, the host's time to record.",
                 "cloth_bench");
    try
    {
        declare(app, options);
        declare_results(app, options);
        app.parse(argc, argv);
        if (!options.compared.empty())
            compare_files(options.compared);
        else if (!options.plot.empty())
            write_plot(options.plot, options.results);
        else if (options.peers)
            std::fputs(bench::peer_report().c_str(), stdout);
        else if (options.list)
            list_cases(real_cases_of(options));
        else if (options.list_devices)
            list_devices();
        else
            run(options);
        return 0;
    }
    catch (const CLI::CallForHelp&)
    {
        std::fputs(app.help().c_str(), stdout);
        return 0;
    }
    catch (const std::exception& error)
    {
        std::fprintf(stderr, "cloth_bench: %s\n", first_line(error.what()).c_str());
        return 1;
    }
}
