#include <sys/statvfs.h>
#include <unistd.h>

#include <iostream>
#include <thread>

#include "cli/commands.h"
#include "cli/install_dirs.h"
#include "cli/open_database.h"
#include "cli/support_bundle.h"
#include "core/text/timestamp.h"
#include "render/renderer.h"
#include "store/cluster/archive_keeper.h"
#include "store/cluster/cluster_process.h"
#include "store/cluster/inspect.h"

namespace strata::cli {
namespace {

constexpr double kGiB = 1024.0 * 1024 * 1024;

// Prints one line per result, with advice after an arrow. Keeps the text for the support bundle.
class Report {
 public:
  void good(const std::string& what, const std::string& value) { line("ok  ", what, value); }
  void warn(const std::string& what, const std::string& value, const std::string& advice) {
    line("warn", what, value);
    print("      → " + advice);
  }
  void bad(const std::string& what, const std::string& value, const std::string& advice) {
    line("FAIL", what, value);
    print("      → " + advice);
    failed_ = true;
  }
  bool failed() const { return failed_; }
  const std::string& text() const { return text_; }

 private:
  void line(const char* mark, const std::string& what, const std::string& value) {
    print(std::string(mark) + "  " + what + ": " + value);
  }
  void print(const std::string& text) {
    std::cout << text << "\n";
    text_ += text + "\n";
  }
  std::string text_;
  bool failed_ = false;
};

std::string gib(double bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f GiB", bytes / kGiB);
  return text;
}

// Returns the vendor, the versions and the limits that OpenGL reports.
nlohmann::json check_gpu(Report& report) {
  render::RendererOptions options;
  options.shader_dir = install_dirs().shaders.string();
  auto renderer = render::Renderer::start(options);
  if (!renderer) {
    report.bad(
        "Graphics", renderer.error().detail,
        "Install libegl1 and libgl1-mesa-dri (software), or the GPU vendor's driver with EGL support.");
    return {{"problem", renderer.error().detail}};
  }
  const auto info = (*renderer)->info();
  report.good("OpenGL vendor", info.vendor);
  report.good("OpenGL version", info.version);
  if (info.software)
    report.warn(
        "Renderer", info.renderer + " (software)",
        "Strata works, but the processor draws the pictures. Large models need a GPU with an EGL driver.");
  else
    report.good("Renderer", info.renderer + " (hardware)");
  report.good("Largest texture", std::to_string(info.max_texture_size) + ", array layers " +
                                     std::to_string(info.max_array_layers) + ", texture units " +
                                     std::to_string(info.max_texture_units) + ", image units " +
                                     std::to_string(info.max_image_units));
  if (info.max_texture_size < 8192)
    report.warn("Layer resolution", "at most " + std::to_string(info.max_texture_size),
                "Use layers of up to that resolution.");
  return {{"vendor", info.vendor},
          {"renderer", info.renderer},
          {"version", info.version},
          {"software", info.software},
          {"paints_by", info.edit_path == render::EditPath::kernel ? "processor" : "GPU"},
          {"memory_limit_bytes", (*renderer)->gpu_bytes_limit()},
          {"max_texture_size", info.max_texture_size},
          {"max_array_layers", info.max_array_layers},
          {"max_texture_units", info.max_texture_units},
          {"max_image_units", info.max_image_units}};
}

void check_schema(Report& report, const store::DatabaseState& state) {
  const std::string versions = "version " + std::to_string(state.schema_version) +
                               ", this program has " + std::to_string(state.known_version);
  if (state.schema_version > state.known_version && state.readable_from > state.known_version)
    report.bad("Schema", versions + ", and programs need " + std::to_string(state.readable_from),
               "The database is newer. " + store::newer_version_advice(state.applied_by));
  else if (state.schema_version > state.known_version)
    report.warn("Schema", versions + ", and can use the database",
                "Another node has a newer version of Strata: install it for this node, too.");
  else if (state.schema_version == 0)
    report.good("Schema", "none: the first start creates it");
  else if (state.schema_version < state.known_version)
    report.good(
        "Schema",
        versions + ": the next start updates it; running nodes of the older version " +
            (state.readable_after_update <= state.schema_version ? "can continue"
                                                                 : "must be stopped first"));
  else
    report.good("Schema", "version " + std::to_string(state.schema_version));
}

void check_connection(Report& report, const std::string& dsn, const std::string& which) {
  auto state = store::inspect_database(dsn, install_dirs().migrations);
  if (!state) return report.bad("PostgreSQL", state.error().title, state.error().detail);
  report.good("PostgreSQL", state->server_version + ", " + which);
  if (state->encoding != "UTF8")
    report.bad("Encoding", state->encoding, "Strata needs a database made with ENCODING 'UTF8'.");
  check_schema(report, *state);
  report.good("Database size", gib(double(state->bytes)));
}

void check_archive(Report& report, const std::string& dsn) {
  const auto state = store::archiver_state(dsn);
  if (!state || !state->archiving) return;
  const std::string last =
      state->archived ? "last segment at " + utc_text(*state->archived) : "no segment yet";
  if (state->failing)
    report.bad("Archive", "PostgreSQL cannot write to it, " + last,
               "Check the free space and the permissions of the folder of --archive. The end of "
               "postgres/postgres.log in the data folder shows the reason.");
  else
    report.good("Archive", last);
}

// Reports that the private cluster can be updated.
void check_version(Report& report, const store::Cluster::State& state) {
  const auto installed = store::installed_programs();
  if (state.version == 0 || installed.empty() || installed.rbegin()->first <= state.version) return;
  report.good("PostgreSQL update",
              "PostgreSQL " + std::to_string(installed.rbegin()->first) +
                  " is installed, too; `strata upgrade-database` shows how to change to it");
}

// Only reads. Does not create, start or migrate a database, and does not disturb a running server.
void check_database(Report& report, const DataOptions& options) {
  if (!options.database.empty()) return check_connection(report, options.database, "external");
  const auto state = store::Cluster::inspect(options.data);
  const std::string where = "private cluster in " + options.data.string();
  if (!state.trouble) check_version(report, state);
  if (state.running) {
    check_connection(report, state.dsn, where + ", a server is running");
    return check_archive(report, state.dsn);
  }
  if (state.trouble) return report.bad("PostgreSQL", state.trouble->title, state.trouble->detail);
  if (state.version == 0)
    return report.good("PostgreSQL", "installed; the first start creates the " + where);
  report.good("PostgreSQL", std::to_string(state.version) + ", " + where + ", not running");
}

void check_machine(Report& report, const std::filesystem::path& data) {
  struct statvfs disk {};
  if (statvfs(std::filesystem::exists(data) ? data.c_str() : ".", &disk) == 0) {
    const double free = double(disk.f_bavail) * double(disk.f_frsize);
    if (free < 2 * kGiB)
      report.warn(
          "Disk", gib(free) + " free",
          "Strata stores every edit: free some space, or choose a larger disk with --data.");
    else
      report.good("Disk", gib(free) + " free");
  }
  const double memory = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGE_SIZE));
  if (memory < 3.5 * kGiB)
    report.warn("Memory", gib(memory),
                "Models of more than a million triangles need 4 GiB or more.");
  else
    report.good("Memory", gib(memory));
  const unsigned cores = std::thread::hardware_concurrency();
  if (cores < 2)
    report.warn("Processor", "1 core", "Drawing and encoding need a core each: use two or more.");
  else
    report.good("Processor", std::to_string(cores) + " cores");
  const auto page = install_dirs().web_client / "index.html";
  if (std::filesystem::exists(page))
    report.good("Web page", page.parent_path().string());
  else
    report.warn("Web page", "not built",
                "Run `npm ci && npm run build` in web-client, or start with ./run.");
}

}  // namespace

Command add_doctor(CLI::App& app) {
  auto* command =
      app.add_subcommand("doctor", "Check graphics, PostgreSQL and the machine, and give advice");
  auto options = std::make_shared<DataOptions>();
  auto support = std::make_shared<SupportOptions>();
  add_data_options(*command, *options);
  auto* file = command->add_option(
      "--support", support->file,
      "Also write a zip file for a report of a problem, without secrets and names");
  command
      ->add_option("--log-file", support->log_files,
                   "Log whose last lines the bundle contains (repeat for several)")
      ->needs(file);
  command
      ->add_option("--listen", support->listen,
                   "Address of the running server, HOST:PORT, for its metrics")
      ->envname("STRATA_LISTEN")
      ->capture_default_str();
  return [options, support] {
    Report report;
    const nlohmann::json graphics = check_gpu(report);
    check_database(report, *options);
    check_machine(report, options->data);
    std::cout << std::flush;
    if (!support->file.empty()) {
      auto written = write_support_bundle(*options, *support, report.text(), graphics);
      if (!written) return cli::report(written.error());
      std::cout << "wrote " << support->file.string()
                << "\nRead it before you send it: MANIFEST.txt lists its files." << std::endl;
    }
    return report.failed() ? 1 : 0;
  };
}

}  // namespace strata::cli
