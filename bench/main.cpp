// cloth_bench: what the solver costs on a device, one line a case. Without a window.
#include "cases.hpp"
#include "device_probe.hpp"
#include "measure.hpp"
#include "report.hpp"

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
    uint32_t repetitions = 0; // 0: by device
    uint32_t workgroup = cloth::SolverOptions().workgroup_size;
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
                   "else what there is")
        ->type_name("INDEX|NAME");
    app.add_option("--csv", options.csv, "Append a row a case to this file; keep one file a machine")
        ->type_name("FILE");
    app.add_option("--repeat", options.repetitions, "Repetitions of each measurement; default: 100, on CPU devices 20")
        ->type_name("N")
        ->check(CLI::Range(1u, k_most));
    app.add_option("--workgroup", options.workgroup, "Threads of a workgroup, a power of two; default: the solver's")
        ->type_name("N");
}

std::vector<const bench::Case*> chosen_cases(const std::vector<std::string>& names)
{
    std::vector<const bench::Case*> result;
    for (const std::string& name : names)
    {
        result.push_back(bench::find_case(name));
        if (result.back() == nullptr)
            throw engine::StartupError("--case " + name + ": there is no such case; --list shows them");
    }
    if (names.empty())
        for (const bench::Case& item : bench::cases())
            result.push_back(&item);
    return result;
}

void list_cases()
{
    for (const bench::Case& item : bench::cases())
        std::printf("%-28s %s\n", item.name, item.purpose);
}

void list_devices()
{
    uint32_t index = 0;
    for (const engine::DeviceInfo& device : engine::list_devices())
        std::printf("%u  %s%s%s\n", index++, device.name.c_str(), device.unusable.empty() ? "" : ": ",
                    device.unusable.c_str());
}

void run(const Options& options)
{
    const std::vector<const bench::Case*> chosen = chosen_cases(options.names);
    std::optional<bench::CsvFile> csv;
    if (!options.csv.empty())
        csv = engine::take(bench::CsvFile::open(options.csv));

    engine::DeviceOptions wanted;
    wanted.device = options.device;
    const engine::Device device(wanted);
    bench::TimedQueue queue(device);
    const bench::DeviceProbe probe = bench::probe_device(queue);
    const uint32_t repetitions = options.repetitions > 0 ? options.repetitions : device.is_cpu() ? 20 : 100;
    bench::print_device(device.info(), probe);
    bench::print_header();
    for (const bench::Case* item : chosen)
    {
        const bench::Measurement measurement = bench::measure(queue, *item, repetitions, options.workgroup);
        bench::print_row(*item, measurement, probe);
        if (csv)
            engine::take(csv->append(device.info(), probe, *item, measurement, repetitions));
    }
}

// CLI11's own words run over several lines.
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
        app.parse(argc, argv);
        if (options.list)
            list_cases();
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
