// The table on standard output and the CSV file.
#include "report.hpp"

#include <cinttypes>
#include <cstdio>
#include <fstream>
#include <sstream>

namespace bench
{

namespace
{

constexpr const char* k_columns =
    "device,driver,copy_bytes_per_second,empty_dispatch_us,case,vertices,triangles,substeps_per_frame,"
    "dispatches_per_frame,substeps_measured,repetitions,contacts,gpu_us_per_substep_median,gpu_us_per_substep_p95,"
    "bytes_per_substep,bandwidth_fraction,record_us_per_frame_median,record_allocations";

// RFC 4180: the text is quoted and quotes are doubled. Device names contain commas.
std::string quoted(const std::string& text)
{
    std::string result = "\"";
    for (const char c : text)
    {
        if (c == '"')
            result += '"';
        result += c;
    }
    return result + '"';
}

double fraction_of_copy(double bytes, double microseconds, const DeviceProbe& probe)
{
    return bytes / (microseconds * 1e-6) / probe.copy_bandwidth;
}

} // namespace

double bandwidth_fraction(const Measurement& measurement, const DeviceProbe& probe)
{
    return fraction_of_copy(measurement.bytes, measurement.gpu_median, probe);
}

void print_device(const voile::engine::DeviceInfo& device, const DeviceProbe& probe)
{
    std::printf("device          %s\n", device.name.c_str());
    std::printf("driver          %s\n", device.driver.c_str());
    std::printf("copy bandwidth  %.1f GB/s, read plus written\n", probe.copy_bandwidth * 1e-9);
    std::printf("empty dispatch  %.2f us, with its barrier\n\n", probe.empty_dispatch);
}

void print_header()
{
    std::printf("%-28s %8s %9s %8s %10s %10s %10s %10s %9s %9s %6s\n", "", "", "", "substeps", "dispatches", "GPU us",
                "/substep", "MB moved", "bandwidth", "record us", "heap");
    std::printf("%-28s %8s %9s %8s %10s %10s %10s %10s %9s %9s %6s\n", "case", "vertices", "triangles", "/frame",
                "/frame", "median", "p95", "/substep", "fraction", "/frame", "allocs");
    std::fflush(stdout);
}

void print_row(const Case& item, const Measurement& m, const DeviceProbe& probe)
{
    std::printf("%-28s %8u %9u %8u %10u %10.1f %10.1f %10.3f %8.1f%% %9.1f %6" PRIu64, item.name, m.vertices,
                m.triangles, m.substeps, m.dispatches, m.gpu_median, m.gpu_p95, m.bytes * 1e-6,
                100 * bandwidth_fraction(m, probe), m.record_median, m.record_allocations);
    if (m.visits > 0)
        std::printf("  %.1f nodes per traversal", m.visits);
    std::printf("\n");
    std::fflush(stdout);
}

void print_drape_header()
{
    std::printf(
        "\nThe drape scene, whole frames of 1/60 s. A run counts if 99 %% of the structural springs stay under 12 %%\n"
        "stretch, all are under 15 %% at the end, at most 0.1 %% of the vertices lie deeper than 5 mm in the heart,\n"
        "and the mean height after 30 frames is under 0.30 m. With a budget of substeps: 99 %% under 8 %%, and the\n"
        "depth.\n\n");
    std::printf("%-20s %8s %8s %10s %9s %9s %10s %9s %7s %8s  %s\n", "case", "vertices", "substeps", "dispatches",
                "median ms", "p95 ms", "99% stretch", "last max", "deep", "height", "counts");
    std::fflush(stdout);
}

void print_drape_row(const DrapeCase& item, const DrapeMeasurement& m)
{
    std::printf("%-20s %8u %8u %10u %9.3f %9.3f %9.2f %% %7.2f %% %5.2f %% %6.3f m  %s\n", item.name, m.vertices,
                m.substeps, m.dispatches, m.gpu_median, m.gpu_p95, 100 * m.stretch_99, 100 * m.last_stretch,
                100 * m.deep_fraction, m.height, m.valid() ? "yes" : "NO");
    std::fflush(stdout);
}

void print_real_header()
{
    std::printf(
        "\nCotton of 1.6 m over meshes of 1 m, whole frames of 1/60 s. Crossings: intersecting pairs of cloth and\n"
        "collider, the most and at the end.\n\n");
    std::printf("%-32s %8s %9s %8s %10s %9s %9s %9s %9s\n", "case", "vertices", "triangles", "substeps", "dispatches",
                "median ms", "p95 ms", "crossings", "last");
    std::fflush(stdout);
}

void print_real_row(const RealCase& item, const RealMeasurement& m)
{
    std::printf("%-32s %8u %9u %8u %10u %9.3f %9.3f %9u %9u\n", item.name.c_str(), m.vertices, m.triangles, m.substeps,
                m.dispatches, m.gpu_median, m.gpu_p95, m.most_crossings, m.last_crossings);
    std::fflush(stdout);
}

void print_refit_header()
{
    std::printf("\nThe refit of a deforming mesh's hierarchy. The floor is its bytes at the copy's bandwidth and its\n"
                "dispatches as if they were empty.\n\n");
    std::printf("%-20s %8s %9s %10s %10s %10s %9s %10s %9s %9s\n", "case", "vertices", "triangles", "dispatches",
                "median us", "p95 us", "MB moved", "floor us", "bandwidth", "build ms");
    std::fflush(stdout);
}

void print_refit_row(const RefitCase& item, const RefitMeasurement& m, const DeviceProbe& probe)
{
    std::printf("%-20s %8u %9u %10u %10.1f %10.1f %9.3f %10.1f %8.1f%% %9.1f\n", item.name, m.vertices, m.triangles,
                m.dispatches, m.gpu_median, m.gpu_p95, m.bytes * 1e-6, refit_floor(m, probe),
                100 * fraction_of_copy(m.bytes, m.gpu_median, probe), m.build);
    std::fflush(stdout);
}

void print_add_header()
{
    std::printf(
        "\nSolver::add_collider of a mesh, milliseconds of the host: built, and from the cache of hierarchies.\n\n"
        "%-20s %9s %12s %12s %12s\n",
        "case", "triangles", "built median", "least", "again median");
    std::fflush(stdout);
}

void print_add_row(const AddCase& item, const AddMeasurement& m)
{
    std::printf("%-20s %9zu %12.1f %12.1f %12.1f\n", item.name, m.triangles, m.built_median, m.built_least,
                m.again_median);
    std::fflush(stdout);
}

void print_costs(std::span<const HostCost> costs)
{
    std::printf("\nWhat adding takes of the host, milliseconds, medians: by the clock, and of the processor.\n\n"
                "%-38s %9s %9s %9s\n",
                "what", "size", "clock", "processor");
    for (const HostCost& cost : costs)
        std::printf("%-38s %9zu %9.1f %9.1f\n", cost.what, cost.size, cost.clock, cost.processor);
    std::fflush(stdout);
}

void print_levels(std::span<const LevelsMeasurement> levels)
{
    std::printf("\nA soft sheet beside a stiff one of 1,024 vertices, Verlet; GPU milliseconds per frame, medians.\n\n"
                "%-12s %9s %9s %12s %12s %12s\n",
                "vertices", "stiff", "soft", "one level", "two levels", "by default");
    for (const LevelsMeasurement& row : levels)
        std::printf("%4u x %-5u %9u %9u %12.3f %12.3f %12.3f\n", row.side, row.side, row.stiff_substeps,
                    row.soft_substeps, row.one_level, row.two_levels, row.by_default);
    std::fflush(stdout);
}

void print_garments(std::span<const GarmentsMeasurement> rows)
{
    std::printf(
        "\nFigures of 20 capsules, each in a cape of cotton, Verlet; medians per frame of 1/60 s. One figure is\n"
        "larger, and its cape as large as those of the others together, of the same spacing.\n\n%-9s %-9s %-7s %9s "
        "%10s %9s %9s %9s %9s %9s %7s\n",
        "figures", "cape", "", "substeps", "dispatches", "GPU ms", "p95 ms", "move us", "record us", "contacts",
        "inside");
    for (const GarmentsMeasurement& row : rows)
        std::printf("%-9u %3u^2     %-7s %9u %10u %9.3f %9.3f %9.1f %9.1f %9u %7u\n", row.figures, row.side,
                    row.moving ? "walk" : "stand", row.substeps, row.dispatches, row.gpu, row.gpu_p95, row.move,
                    row.record, row.contacts, row.inside);
    std::fflush(stdout);
}

void print_record_cost(std::span<const RecordCost> costs)
{
    std::printf("\nWhat recording takes of the host, medians per command or pass.\n\n%-40s %9s %9s\n", "command",
                "host ns", "GPU us");
    for (const RecordCost& cost : costs)
        if (cost.gpu > 0)
            std::printf("%-40s %9.0f %9.2f\n", cost.what, cost.host, cost.gpu);
        else
            std::printf("%-40s %9.0f\n", cost.what, cost.host);
    std::fflush(stdout);
}

voile::Result<CsvFile> CsvFile::open(const std::string& path)
{
    std::string first_line;
    if (std::ifstream existing(path); existing)
        std::getline(existing, first_line);
    if (!first_line.empty() && first_line != k_columns)
        return voile::Error{path + ": its first line is not the header of this program's columns"};
    std::ofstream file(path, std::ios::app);
    if (first_line.empty())
        file << k_columns << '\n';
    file.flush();
    if (!file)
        return voile::Error{path + ": cannot be written"};
    return CsvFile(path);
}

voile::Result<void> CsvFile::append(const voile::engine::DeviceInfo& device, const DeviceProbe& probe, const Case& item,
                                    const Measurement& m, uint32_t repetitions) const
{
    std::ostringstream row;
    row.precision(6);
    row << quoted(device.name) << ',' << quoted(device.driver) << ',' << probe.copy_bandwidth << ','
        << probe.empty_dispatch << ',' << item.name << ',' << m.vertices << ',' << m.triangles << ',' << m.substeps
        << ',' << m.dispatches << ',' << m.measured << ',' << repetitions << ',' << m.contacts << ',' << m.gpu_median
        << ',' << m.gpu_p95 << ',' << m.bytes << ',' << bandwidth_fraction(m, probe) << ',' << m.record_median << ','
        << m.record_allocations << '\n';
    return append(row.str());
}

voile::Result<void> CsvFile::append(const voile::engine::DeviceInfo& device, const DeviceProbe& probe,
                                    const DrapeCase& item, const DrapeMeasurement& m) const
{
    const double microseconds = 1000. / m.substeps;
    std::ostringstream row;
    row.precision(6);
    row << quoted(device.name) << ',' << quoted(device.driver) << ',' << probe.copy_bandwidth << ','
        << probe.empty_dispatch << ',' << item.name << ',' << m.vertices << ',' << m.triangles << ',' << m.substeps
        << ',' << m.dispatches << ',' << m.substeps << ",60,," << m.gpu_median * microseconds << ','
        << m.gpu_p95 * microseconds << ",,,,\n";
    return append(row.str());
}

voile::Result<void> CsvFile::append(const voile::engine::DeviceInfo& device, const DeviceProbe& probe,
                                    const RefitCase& item, const RefitMeasurement& m, uint32_t repetitions) const
{
    std::ostringstream row;
    row.precision(6);
    row << quoted(device.name) << ',' << quoted(device.driver) << ',' << probe.copy_bandwidth << ','
        << probe.empty_dispatch << ',' << item.name << ',' << m.vertices << ',' << m.triangles << ",1," << m.dispatches
        << ",1," << repetitions << ",," << m.gpu_median << ',' << m.gpu_p95 << ',' << m.bytes << ','
        << fraction_of_copy(m.bytes, m.gpu_median, probe) << ",,\n";
    return append(row.str());
}

voile::Result<void> CsvFile::append(const std::string& row) const
{
    std::ofstream file(path_, std::ios::app);
    file << row;
    file.flush();
    if (!file)
        return voile::Error{path_ + ": cannot be written"};
    return {};
}

} // namespace bench
