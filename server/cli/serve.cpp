#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <iostream>
#include <memory>
#include <optional>
#include <thread>

#include "app/nodes/node_lease.h"
#include "cli/commands.h"
#include "cli/install_dirs.h"
#include "cli/open_database.h"
#include "core/log.h"
#include "core/version.h"
#include "jobs/job_queue.h"
#include "net/transport/server.h"
#include "render/renderer.h"
#include "room/room.h"
#include "room/rooms.h"
#include "sign_on/config.h"
#include "store/cluster/archive_keeper.h"
#include "store/files/files.h"
#include "store/nodes/nodes.h"
#include "store/people/accounts.h"
#include "store/people/tokens.h"
#include "store/tables/attachments.h"
#include "stream/jpeg_pool.h"
#include "stream/viewer.h"

namespace strata::cli {
namespace {

constexpr int kMaxTrashDays = 36500, kMaxAuditDays = 36500, kMaxFileDays = 36500;
constexpr int kMaxMergeAfter_s = 86'400;
constexpr int kMaxCopyDays = 365, kMaxCopies = 1000;
constexpr int kMaxTimeout_s = 3600;
constexpr int kMaxSlow_ms = 3'600'000;

struct ServeOptions {
  DataOptions data;
  std::string listen = "127.0.0.1:8080", sql_listen, node_url;
  std::vector<std::string> origins;
  std::filesystem::path tls_cert, tls_key, oidc_config;
  std::string local_accounts = "on", followers = "on";
  int archive_copy_days = 7, archive_copies = 4;
  std::uint64_t gpu_memory = 0, memory = 0;
  int trash_days = net::ServerOptions{}.trash_days;
  int audit_days = net::ServerOptions{}.audit_days;
  int file_days = net::ServerOptions{}.file_days;
  int merge_after_s = static_cast<int>(net::ServerOptions{}.merge_after.count());
  net::Timeouts timeouts;
  int samples_at_rest = 16, smooth_samples = 0;
  bool debug = false;
  log::Levels log_levels;
  log::Format log_format = log::Format::text;
  int slow_after_ms = 1000;
};

struct Address {
  std::string host;
  std::uint16_t port = 0;
};

bool is_loopback(const std::string& host) {
  return host == "127.0.0.1" || host == "::1" || host == "localhost";
}

Result<Address> parse_address(const std::string& text, const std::string& option) {
  const auto colon = text.rfind(':');
  if (colon == std::string::npos)
    return fail(ErrorCode::malformed, "Invalid listen address",
                "Enter HOST:PORT, for example 127.0.0.1:8080.", option);
  Address address{text.substr(0, colon), 0};
  if (address.host.size() > 2 && address.host.front() == '[')
    address.host = address.host.substr(1, address.host.size() - 2);
  const std::string port = text.substr(colon + 1);
  char* end = nullptr;
  const long number = std::strtol(port.c_str(), &end, 10);
  if (port.empty() || *end != '\0' || number < 0 || number > 65535)
    return fail(ErrorCode::malformed, "Invalid listen address",
                "The port must be a number from 0 (any free port) to 65535.", option);
  address.port = static_cast<std::uint16_t>(number);
  return address;
}

Result<Address> parse_listen(const std::string& text) { return parse_address(text, "--listen"); }

// Refuses an address that other machines can reach, unless an administrator can sign in or a
// provider of OpenID Connect is configured.
Result<void> check_reach(store::Store& store, const Address& address, bool has_tls,
                         bool has_passwords, bool has_provider) {
  if (is_loopback(address.host)) return {};
  const auto has_administrator =
      STRATA_TRY(store.accounts().administrator_can_sign_in(has_passwords));
  if (has_administrator || has_provider) {
    if (!has_tls)
      log::warning(
          "listening on " + address.host +
          " without --tls-cert: passwords are sent without encryption unless a proxy in front of this server uses TLS");
    return {};
  }
  return fail(
      ErrorCode::forbidden, "Administrator account missing",
      "Other computers can reach " + address.host +
          ", but no administrator has a password. Create an account: strata user add NAME --role administrator "
          "--password-stdin. Alternatively, let people sign in with --oidc-config, or listen on 127.0.0.1.",
      "--listen");
}

// Reads the providers of OpenID Connect. Returns an empty list without a file.
Result<std::vector<sign_on::Provider>> read_providers(const ServeOptions& options) {
  if (!options.oidc_config.empty()) return sign_on::read_config(options.oidc_config);
  if (options.local_accounts == "on") return std::vector<sign_on::Provider>();
  return fail(ErrorCode::invalid, "Nobody could sign in",
              "Without local accounts, the server needs an OpenID Connect provider. Specify "
              "its configuration with --oidc-config.",
              "--local-accounts");
}

Result<store::SqlListen> parse_sql_listen(const std::string& text) {
  auto address = STRATA_TRY(parse_address(text, "--sql-listen"));
  if (address.port == 0)
    return fail(ErrorCode::malformed, "Invalid listen address",
                "The database needs its own port: enter a number from 1 to 65535.", "--sql-listen");
  if (!is_loopback(address.host))
    return fail(
        ErrorCode::forbidden, "Listen address not allowed",
        "SQL connections are not encrypted, so --sql-listen accepts only loopback addresses, such as "
        "127.0.0.1:5433. From other computers, use an SSH tunnel: ssh -L 5433:127.0.0.1:5433 HOST.",
        "--sql-listen");
  return store::SqlListen{address.host, address.port};
}

// For CLI11. Returns the error if the text is not an address. Ignores all other errors.
template <class Parse>
std::string usage_of(Parse parse, const std::string& text) {
  const auto address = parse(text);
  return address || address.error().code != ErrorCode::malformed ? std::string()
                                                                 : address.error().detail;
}

std::string owner_token() {
  const char* token = std::getenv("STRATA_OWNER_TOKEN");
  return token ? token : "";
}

// `wait_for_end` receives the signals, so no handlers are needed. All threads inherit the signal
// mask because it is set before they start.
sigset_t block_signals() {
  sigset_t ending;
  sigemptyset(&ending);
  sigaddset(&ending, SIGTERM);
  sigaddset(&ending, SIGINT);
  sigaddset(&ending, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &ending, nullptr);
  signal(SIGPIPE, SIG_IGN);
  return ending;
}

void wait_for_end(const sigset_t& ending) {
  int signal = 0;
  while (sigwait(&ending, &signal) != 0) {
  }
}

// Each connection needs a file descriptor. The default limit is half of the maximum number of
// connections.
void raise_descriptor_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, 65536);
  setrlimit(RLIMIT_NOFILE, &limit);
}

void add_timeout(CLI::App& command, const std::string& name, std::chrono::seconds& timeout,
                 const std::string& what) {
  std::string variable = "STRATA_" + name;
  for (char& letter : variable)
    letter = letter == '-' ? '_' : static_cast<char>(std::toupper(letter));
  command
      .add_option_function<int>(
          "--" + name, [&timeout](int seconds) { timeout = std::chrono::seconds(seconds); }, what)
      ->envname(variable)
      ->check(CLI::Range(1, kMaxTimeout_s))
      ->default_str(std::to_string(timeout.count()));
}

void add_log_options(CLI::App& command, ServeOptions& options) {
  command
      .add_option_function<std::string>(
          "--log-level",
          [&options](const std::string& text) { options.log_levels = *log::parse_levels(text); },
          "Lowest level of the messages to log; a module can have its own level, for example "
          "warning,store=debug")
      ->envname("STRATA_LOG_LEVEL")
      ->check([](const std::string& text) {
        const auto levels = log::parse_levels(text);
        return levels ? std::string() : levels.error().detail;
      })
      ->default_str("info");
  command
      .add_option_function<std::string>(
          "--log-format",
          [&options](const std::string& text) {
            options.log_format = text == "json" ? log::Format::json : log::Format::text;
          },
          "Format of log lines: text or json")
      ->envname("STRATA_LOG_FORMAT")
      ->check(CLI::IsMember({"text", "json"}))
      ->default_str("text");
  command
      .add_option("--slow-after", options.slow_after_ms,
                  "Milliseconds after which a request or edit is logged as slow; 0 logs none")
      ->envname("STRATA_SLOW_AFTER")
      ->check(CLI::Range(0, kMaxSlow_ms))
      ->capture_default_str();
}

void add_archive_options(CLI::App& command, ServeOptions& options) {
  auto* archive =
      command
          .add_option(
              "--archive", options.data.cluster.archive,
              "Folder for copies of the private database, and for the changes after each copy "
              "(docs/how-to/back-up-and-restore.md)")
          ->envname("STRATA_ARCHIVE");
  command
      .add_option("--archive-copy-days", options.archive_copy_days,
                  "Days between two copies in the archive")
      ->envname("STRATA_ARCHIVE_COPY_DAYS")
      ->needs(archive)
      ->check(CLI::Range(1, kMaxCopyDays))
      ->capture_default_str();
  command
      .add_option("--archive-copies", options.archive_copies,
                  "Number of copies that the archive keeps, with all changes since the oldest")
      ->envname("STRATA_ARCHIVE_COPIES")
      ->needs(archive)
      ->check(CLI::Range(1, kMaxCopies))
      ->capture_default_str();
}

int run(ServeOptions options) {
  log::set_format(options.log_format);
  log::set_levels(options.log_levels);
  raise_descriptor_limit();
  auto address = parse_listen(options.listen);
  if (!address) return report(address.error());
  if (!options.sql_listen.empty()) {
    auto sql = parse_sql_listen(options.sql_listen);
    if (!sql) return report(sql.error());
    if (!options.data.database.empty())
      return report(
          {ErrorCode::malformed, "Not a private database",
           "If you use --database, give analysts access to that PostgreSQL server. docs/how-to/query-with-sql.md lists the statements.",
           "--sql-listen"});
    options.data.cluster.sql = std::move(*sql);
  }
  if (!options.data.cluster.archive.empty() && !options.data.database.empty())
    return report(
        {ErrorCode::malformed, "Not a private database",
         "If you use --database, archive that PostgreSQL server with its own tools, such as pgBackRest (docs/how-to/back-up-and-restore.md).",
         "--archive"});
  std::optional<store::NewNode> node;
  if (!options.node_url.empty()) {
    auto url = store::check_node_url(options.node_url);
    if (!url) return report(url.error());
    node = store::NewNode{random_uuid(), std::move(*url), std::string(version()), {}};
    options.data.database = store::with_sessions_of(node->id, options.data.database);
  }
  auto providers = read_providers(options);
  if (!providers) return report(providers.error());
  const sigset_t ending = block_signals();

  const InstallDirs dirs = install_dirs();
  auto database = open_database(options.data);
  if (!database) return report(database.error());
  store::Store& store = *(*database)->store;
  const bool has_passwords = options.local_accounts == "on";
  if (auto safe = check_reach(store, *address, !options.tls_cert.empty(), has_passwords,
                              !providers->empty());
      !safe)
    return report(safe.error());
  std::unique_ptr<store::ArchiveKeeper> archive;
  if (!options.data.cluster.archive.empty())
    archive = std::make_unique<store::ArchiveKeeper>(
        *(*database)->cluster,
        store::ArchiveRules{std::chrono::days(options.archive_copy_days), options.archive_copies});
  if (auto found = store.files().check_open(); !found) return report(found.error());
  if (store.files().is_open()) {
    auto owns = store.files().owns_files();
    if (!owns) return report(owns.error());
    if (!*owns)
      log::warning(
          "this database is a copy, and the original owns the files, so this server deletes no "
          "files, and stores new files in the database. To make the copy the owner: strata files "
          "adopt");
  }
  if (node && !store.files().is_open()) {
    const auto facts = store.files().facts();
    if (!facts) return report(facts.error());
    if (!facts->place.empty())
      log::warning("this site has used --files " + facts->place +
                   ". If other nodes still use it, this node needs the same option");
  }
  auto orphans = store.attachments().drop_orphans();
  if (!orphans) return report(orphans.error());
  if (*orphans > 0) log::info("deleted " + std::to_string(*orphans) + " unused files");

  render::RendererOptions render_options;
  render_options.shader_dir = dirs.shaders.string();
  render_options.gpu_memory_bytes = options.gpu_memory;
  render_options.debug = options.debug;
  render_options.smooth_samples = options.smooth_samples;
  auto renderer = render::Renderer::start(render_options);
  if (!renderer) return report(renderer.error());
  const auto gpu = (*renderer)->info();
  log::info("drawing with " + gpu.renderer + (gpu.software ? " (software)" : ""));

  stream::JpegPool encoder(std::max(1, static_cast<int>(std::thread::hardware_concurrency()) - 1));
  room::RoomOptions room_options;
  room_options.memory_bytes = options.memory;
  if (node) room_options.node = node->id;
  room_options.follows = options.followers == "on";
  room_options.slow_after = std::chrono::milliseconds(options.slow_after_ms);
  room::Rooms rooms(store, **renderer, {renderer->get(), &encoder, options.samples_at_rest},
                    room_options);
  jobs::JobQueue jobs(&store.jobs(), room_options.node);
  std::unique_ptr<app::NodeLease> lease;
  if (node) {
    node->gpu = gpu.renderer;
    auto joined = app::NodeLease::start(store.nodes(), rooms, {*node});
    if (!joined) return report(joined.error());
    lease = std::move(*joined);
    log::info("joined the site as node " + to_string(node->id) + " at " + node->url);
  }

  net::ServerOptions server_options;
  server_options.host = address->host;
  server_options.port = address->port;
  server_options.allowed_origins = options.origins;
  server_options.static_dir = dirs.web_client;
  server_options.protocol_dir = dirs.protocol;
  server_options.templates_dir = dirs.templates;
  server_options.upload_dir = options.data.data / "uploads";
  server_options.tls_chain = options.tls_cert;
  server_options.tls_key = options.tls_key;
  server_options.owner_token = owner_token();
  server_options.sign_on_providers = std::move(*providers);
  server_options.local_accounts = has_passwords;
  server_options.trash_days = options.trash_days;
  server_options.audit_days = options.audit_days;
  server_options.file_days = options.file_days;
  server_options.merge_after = std::chrono::seconds(options.merge_after_s);
  server_options.timeouts = options.timeouts;
  server_options.lease = lease.get();
  server_options.archive = archive.get();
  server_options.slow_after = std::chrono::milliseconds(options.slow_after_ms);
  auto server = net::Server::start(server_options, store, rooms, jobs, **renderer);
  if (!server) return report(server.error());

  const std::string url = (options.tls_cert.empty() ? "http://" : "https://") +
                          (address->host == "::1" ? "[::1]" : address->host) + ":" +
                          std::to_string((*server)->port());
  std::cout << "listening on " << url << std::endl;
  const auto owner = store.accounts().find("owner");
  if (!owner) return report(owner.error());
  if (const auto& sql = options.data.cluster.sql)
    std::cout << "SQL on " << sql->host << ":" << sql->port
              << ": database strata, user strata_reader, password in "
              << (options.data.data / "sql-password").string() << std::endl;
  // An owner with a password does not need a link, which would appear in logs.
  if (owner->has_password && has_passwords) {
    std::cout << "sign in at: " << url << "/" << std::endl;
  } else {
    auto link = store.tokens().create_link(store::TokenKind::owner_link, owner->name,
                                           std::chrono::hours(24));
    if (!link) return report(link.error());
    std::cout << "owner link: " << url << "/login?link=" << link->secret << std::endl;
  }

  if ((*database)->cluster) (*database)->cluster->watch();
  wait_for_end(ending);
  log::info("stopping: no new edits, saving accepted edits");
  if (lease) {
    // The connections stay open until the clients have received the new address of each model.
    lease->begin_drain();
    rooms.drain();
  }
  (*server)->stop();
  jobs.stop();  // jobs use parts of the server, and a canceled job may still submit an edit
  if (!lease) rooms.drain();
  if (lease) lease->leave();
  return 0;
}

}  // namespace

Command add_serve(CLI::App& app) {
  auto* command = app.add_subcommand("serve", "Run the server");
  auto options = std::make_shared<ServeOptions>();
  add_data_options(*command, options->data);
  add_files_options(*command, options->data);
  command
      ->add_option("--listen", options->listen,
                   "Address of the server, HOST:PORT; port 0 selects a free port")
      ->envname("STRATA_LISTEN")
      ->check([](const std::string& text) { return usage_of(parse_listen, text); })
      ->capture_default_str();
  command
      ->add_option("--sql-listen", options->sql_listen,
                   "Address for reading with SQL, HOST:PORT (docs/how-to/query-with-sql.md)")
      ->envname("STRATA_SQL_LISTEN")
      ->check([](const std::string& text) { return usage_of(parse_sql_listen, text); });
  command
      ->add_option("--node-url", options->node_url,
                   "HTTP or HTTPS address of this server, if several servers use the same "
                   "--database, for example https://strata.example.org/node/a")
      ->envname("STRATA_NODE_URL")
      ->needs(command->get_option("--database"))  // the nodes of a site share a database
      ->check([](const std::string& text) { return usage_of(store::check_node_url, text); });
  command
      ->add_option("--followers", options->followers,
                   "on: this node shows models of other nodes to viewers and kiosks; off: it sends "
                   "them to these nodes. Only with --node-url")
      ->envname("STRATA_FOLLOWERS")
      ->check(CLI::IsMember({"on", "off"}))
      ->capture_default_str();
  command
      ->add_option("--origin", options->origins,
                   "Allow connections from this web origin (repeat for several)")
      ->envname("STRATA_ORIGIN");
  auto* tls_cert =
      command
          ->add_option(
              "--tls-cert", options->tls_cert,
              "Serve https with this certificate chain (PEM; docs/how-to/operate-a-site.md)")
          ->envname("STRATA_TLS_CERT");
  auto* tls_key = command
                      ->add_option("--tls-key", options->tls_key,
                                   "Key of the certificate (PEM, without a passphrase)")
                      ->envname("STRATA_TLS_KEY");
  tls_cert->needs(tls_key);
  tls_key->needs(tls_cert);
  command
      ->add_option("--oidc-config", options->oidc_config,
                   "Let people sign in with the OpenID Connect providers in this JSON file "
                   "(docs/how-to/sign-in-with-openid-connect.md)")
      ->envname("STRATA_OIDC_CONFIG");
  command
      ->add_option("--local-accounts", options->local_accounts,
                   "on: users can sign in with passwords; off: only with OpenID Connect")
      ->envname("STRATA_LOCAL_ACCOUNTS")
      ->check(CLI::IsMember({"on", "off"}))
      ->capture_default_str();
  command
      ->add_option(
          "--gpu-memory", options->gpu_memory,
          "Limit of GPU memory, for example 4GiB (default: 70 % of the GPU's memory, or 4GiB)")
      ->envname("STRATA_GPU_MEMORY")
      ->transform(CLI::AsSizeValue(false));
  command
      ->add_option(
          "--memory", options->memory,
          "Limit of main memory for open models, for example 8GiB (default: 60 % of the machine's memory)")
      ->envname("STRATA_MEMORY")
      ->transform(CLI::AsSizeValue(false));
  command
      ->add_option(
          "--bin-days", options->trash_days,
          "Days for which deleted layers and models stay in the trash; 0: erase immediately")
      ->envname("STRATA_BIN_DAYS")
      ->check(CLI::Range(0, kMaxTrashDays))
      ->capture_default_str();
  command
      ->add_option("--audit-days", options->audit_days,
                   "Days for which the audit log keeps its rows; 0 keeps them permanently")
      ->envname("STRATA_AUDIT_DAYS")
      ->check(CLI::Range(0, kMaxAuditDays))
      ->capture_default_str();
  command
      ->add_option("--file-days", options->file_days,
                   "Days for which the server keeps an unused file outside the database")
      ->envname("STRATA_FILE_DAYS")
      ->check(CLI::Range(1, kMaxFileDays))
      ->capture_default_str();
  command
      ->add_option("--merge-after", options->merge_after_s,
                   "Seconds from the end of a stroke until its batches become one edit of the "
                   "journal; 0: never")
      ->envname("STRATA_MERGE_AFTER")
      ->check(CLI::Range(0, kMaxMergeAfter_s))
      ->capture_default_str();
  add_archive_options(*command, *options);
  add_timeout(*command, "head-timeout", options->timeouts.head,
              "Seconds from the connection to the end of the first request head");
  add_timeout(*command, "idle-timeout", options->timeouts.idle,
              "Seconds to wait for the next request head, and for the reply to a ping");
  add_timeout(*command, "stall-timeout", options->timeouts.stall,
              "Seconds without progress in a request body or a response");
  add_timeout(*command, "recheck-every", options->timeouts.recheck,
              "Seconds between checks whether a connected user is still signed in");
  command
      ->add_option("--samples-at-rest", options->samples_at_rest,
                   "Samples for each pixel of a frame while nothing changes; 1: no refinement")
      ->envname("STRATA_SAMPLES_AT_REST")
      ->check(CLI::Range(1, render::kMaxSamples))
      ->capture_default_str();
  command
      ->add_option("--samples-in-motion", options->smooth_samples,
                   "Samples for each pixel of a frame while the camera moves; 0: 5 on a fast "
                   "GPU, otherwise 1")
      ->envname("STRATA_SAMPLES_IN_MOTION")
      ->check(CLI::Range(0, render::kMaxSmoothSamples))
      ->capture_default_str();
  add_log_options(*command, *options);
  command->add_flag("--gl-debug", options->debug,
                    "Log debug messages of the graphics driver (slow)");
  return [options] { return run(*options); };
}

}  // namespace strata::cli
