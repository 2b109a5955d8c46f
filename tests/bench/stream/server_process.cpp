#include "bench/stream/server_process.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "bench/harness.h"
#include "core/uuid.h"

namespace strata::bench {
namespace {

constexpr std::chrono::seconds kStarting{180};

[[noreturn]] void stop(const ChildProcess& process, const std::string& binary) {
  std::fprintf(stderr, "strata-bench: %s did not come up; its last words:\n%s\n", binary.c_str(),
               process.last_words().c_str());
  std::exit(1);
}

}  // namespace

ServerProcess::ServerProcess(const std::filesystem::path& binary)
    : folder_(make_temporary_folder()),
      token_(to_string(random_uuid()) + to_string(random_uuid())) {
  const std::filesystem::path data = folder_ / "data";
  std::filesystem::create_directory(data);
  let_others_through(data);
  process_ = std::make_unique<ChildProcess>(
      std::vector<std::string>{"/usr/bin/env", "STRATA_OWNER_TOKEN=" + token_,
                               std::filesystem::absolute(binary).string(), "serve", "--data",
                               data.string(), "--listen", "127.0.0.1:0"},
      folder_ / "server.log");
  const auto port = process_->said("listening on http://127.0.0.1:", kStarting);
  if (!port || !process_->said("owner link: ", kStarting)) stop(*process_, binary.string());
  port_ = static_cast<std::uint16_t>(std::stoi(*port));
  std::ifstream(data / "postgres" / "pgdata" / "postmaster.pid") >> postmaster_;
  if (const auto log = process_->last_words(); log.find("drawing with ") != std::string::npos) {
    renderer_ = log.substr(log.find("drawing with ") + 13);
    renderer_ = renderer_.substr(0, renderer_.find('\n'));
  }
}

ServerProcess::~ServerProcess() {
  process_.reset();
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

ServerProcess::Used ServerProcess::used() const {
  return {processor_seconds(process_->pid()), postmaster_ > 0 ? family_seconds(postmaster_) : 0};
}

}  // namespace strata::bench
