// The printed tables and the CSV file.
#pragma once

#include "add_mesh.hpp"
#include "device_probe.hpp"
#include "drape.hpp"
#include "garments.hpp"
#include "host_costs.hpp"
#include "levels.hpp"
#include "measure.hpp"
#include "real_mesh.hpp"
#include "record_cost.hpp"
#include "refit_case.hpp"

#include <string>

namespace bench
{

void print_device(const voile::engine::DeviceInfo& device, const DeviceProbe& probe);
void print_header();
void print_row(const Case& item, const Measurement& measurement, const DeviceProbe& probe);

void print_drape_header();
void print_drape_row(const DrapeCase& item, const DrapeMeasurement& measurement);

// Without rows in the CSV file: the meshes are not part of the benchmark.
void print_real_header();
void print_real_row(const RealCase& item, const RealMeasurement& measurement);

void print_refit_header();
void print_refit_row(const RefitCase& item, const RefitMeasurement& measurement, const DeviceProbe& probe);

// Host work, without rows in the CSV file.
void print_add_header();
void print_add_row(const AddCase& item, const AddMeasurement& measurement);

void print_costs(std::span<const HostCost> costs);
void print_levels(std::span<const LevelsMeasurement> levels);
void print_garments(std::span<const GarmentsMeasurement> rows);
void print_record_cost(std::span<const RecordCost> costs);

// The fraction of the copy bandwidth that a case reaches.
double bandwidth_fraction(const Measurement& measurement, const DeviceProbe& probe);

// Rows for other programs, one per case, each with the device. New columns are only added at the end.
class CsvFile
{
public:
    // Writes the header if the file is new or empty. Errors: the file cannot be written or has other columns.
    static voile::Result<CsvFile> open(const std::string& path);

    voile::Result<void> append(const voile::engine::DeviceInfo& device, const DeviceProbe& probe, const Case& item,
                               const Measurement& measurement, uint32_t repetitions) const;
    // A row with the mean substep of a whole frame. Bytes and recording are not measured and stay empty.
    voile::Result<void> append(const voile::engine::DeviceInfo& device, const DeviceProbe& probe, const DrapeCase& item,
                               const DrapeMeasurement& measurement) const;
    // A row with a refit instead of a substep. Recording is not measured and stays empty.
    voile::Result<void> append(const voile::engine::DeviceInfo& device, const DeviceProbe& probe, const RefitCase& item,
                               const RefitMeasurement& measurement, uint32_t repetitions) const;

private:
    explicit CsvFile(std::string path) : path_(std::move(path)) {}
    voile::Result<void> append(const std::string& row) const;
    std::string path_;
};

} // namespace bench
