// What the benchmark prints, and the CSV file that it appends to.
#pragma once

#include "add_mesh.hpp"
#include "device_probe.hpp"
#include "drape.hpp"
#include "measure.hpp"
#include "refit_case.hpp"

#include <string>

namespace bench
{

void print_device(const voile::engine::DeviceInfo& device, const DeviceProbe& probe);
void print_header();
void print_row(const Case& item, const Measurement& measurement, const DeviceProbe& probe);

void print_drape_header();
void print_drape_row(const DrapeCase& item, const DrapeMeasurement& measurement);

void print_refit_header();
void print_refit_row(const RefitCase& item, const RefitMeasurement& measurement, const DeviceProbe& probe);

// The host's work; it has no rows in the CSV file.
void print_add_header();
void print_add_row(const AddCase& item, const AddMeasurement& measurement);

// Share of the copy bandwidth that a case reaches.
double bandwidth_share(const Measurement& measurement, const DeviceProbe& probe);

// Rows for other programs, one a case, with the device in each. Columns are only ever added at the end.
class CsvFile
{
public:
    // Writes the header if the file is new or empty. Errors: it cannot be written, or has other columns.
    static voile::gpu::Result<CsvFile> open(const std::string& path);

    voile::gpu::Result<void> append(const voile::engine::DeviceInfo& device, const DeviceProbe& probe, const Case& item,
                                    const Measurement& measurement, uint32_t repetitions) const;
    // A substep's part of a whole frame. Bytes and recording are not measured there and stay empty.
    voile::gpu::Result<void> append(const voile::engine::DeviceInfo& device, const DeviceProbe& probe,
                                    const DrapeCase& item, const DrapeMeasurement& measurement) const;
    // A refit in a substep's place. Recording is not measured there and stays empty.
    voile::gpu::Result<void> append(const voile::engine::DeviceInfo& device, const DeviceProbe& probe,
                                    const RefitCase& item, const RefitMeasurement& measurement,
                                    uint32_t repetitions) const;

private:
    explicit CsvFile(std::string path) : path_(std::move(path)) {}
    voile::gpu::Result<void> append(const std::string& row) const;
    std::string path_;
};

} // namespace bench
