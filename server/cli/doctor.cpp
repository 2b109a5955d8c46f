#include <sys/statvfs.h>
#include <unistd.h>

#include <iostream>
#include <thread>

#include "cli/commands.h"
#include "cli/install_dirs.h"
#include "cli/open_database.h"
#include "render/renderer.h"

namespace strata::cli {
namespace {

constexpr double kGiB = 1024.0 * 1024 * 1024;

// One line a finding; advice is set off by an arrow.
class Report {
 public:
  void good(const std::string& what, const std::string& value) { line("ok  ", what, value); }
  void warn(const std::string& what, const std::string& value, const std::string& advice) {
    line("warn", what, value);
    std::cout << "      → " << advice << "\n";
  }
  void bad(const std::string& what, const std::string& value, const std::string& advice) {
    line("FAIL", what, value);
    std::cout << "      → " << advice << "\n";
    failed_ = true;
  }
  bool failed() const { return failed_; }

 private:
  static void line(const char* mark, const std::string& what, const std::string& value) {
    std::cout << mark << "  " << what << ": " << value << "\n";
  }
  bool failed_ = false;
};

std::string gib(double bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f GiB", bytes / kGiB);
  return text;
}

void check_gpu(Report& report) {
  render::RendererOptions options;
  options.shader_dir = install_dirs().shaders.string();
  auto renderer = render::Renderer::start(options);
  if (!renderer)
    return report.bad("Graphics", renderer.error().detail,
                      "Install libegl1 and libgl1-mesa-dri (software), or the GPU vendor's driver with EGL support.");
  const auto info = (*renderer)->info();
  report.good("OpenGL vendor", info.vendor);
  report.good("OpenGL version", info.version);
  if (info.software)
    report.warn("Renderer", info.renderer + " (software)",
                "Works, with the processor doing the drawing. A GPU with an EGL driver makes large models fluent.");
  else
    report.good("Renderer", info.renderer + " (hardware)");
  report.good("Largest texture", std::to_string(info.max_texture_size) + ", array layers " +
                                     std::to_string(info.max_array_layers) + ", texture units " +
                                     std::to_string(info.max_texture_units) + ", image units " +
                                     std::to_string(info.max_image_units));
  if (info.max_texture_size < 8192)
    report.warn("Layer resolution", "at most " + std::to_string(info.max_texture_size), "Use layers of up to that resolution.");
}

void check_database(Report& report, const DataOptions& options) {
  auto database = open_database(options);
  if (!database) return report.bad("PostgreSQL", database.error().title, database.error().detail);
  auto info = (*database)->store->info();
  if (!info) return report.bad("PostgreSQL", info.error().title, info.error().detail);
  report.good("PostgreSQL", info->server_version + (options.database.empty() ? ", private cluster in " + options.data.string()
                                                                             : ", external"));
  report.good("Schema", "version " + std::to_string(info->schema_version));
  report.good("Database size", gib(double(info->database_bytes)));
}

void check_machine(Report& report, const std::filesystem::path& data) {
  struct statvfs disk {};
  if (statvfs(std::filesystem::exists(data) ? data.c_str() : ".", &disk) == 0) {
    const double free = double(disk.f_bavail) * double(disk.f_frsize);
    if (free < 2 * kGiB)
      report.warn("Disk", gib(free) + " free", "Every edit is kept: make room, or name a larger disk with --data.");
    else
      report.good("Disk", gib(free) + " free");
  }
  const double memory = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGE_SIZE));
  if (memory < 3.5 * kGiB)
    report.warn("Memory", gib(memory), "Models of more than a million triangles need 4 GiB or more.");
  else
    report.good("Memory", gib(memory));
  const unsigned cores = std::thread::hardware_concurrency();
  if (cores < 2)
    report.warn("Processor", "1 core", "Drawing and encoding want a core each: use two or more.");
  else
    report.good("Processor", std::to_string(cores) + " cores");
  const auto page = install_dirs().web_client / "index.html";
  if (std::filesystem::exists(page))
    report.good("Web page", page.parent_path().string());
  else
    report.warn("Web page", "not built", "Run `npm ci && npm run build` in web-client, or start with ./run.");
}

}  // namespace

Command add_doctor(CLI::App& app) {
  auto* command = app.add_subcommand("doctor", "What graphics, PostgreSQL and the machine can do, with advice");
  auto options = std::make_shared<DataOptions>();
  add_data_options(*command, *options);
  return [options] {
    Report report;
    check_gpu(report);
    check_database(report, *options);
    check_machine(report, options->data);
    std::cout << std::flush;
    return report.failed() ? 1 : 0;
  };
}

}  // namespace strata::cli
