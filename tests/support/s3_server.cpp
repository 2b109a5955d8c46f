#include "support/s3_server.h"
#include "strata_dirs.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>

#include "support/test_cluster.h"

namespace strata::test {
namespace {

struct Running {
  TemporaryFolder folder;
  pid_t pid = 0;
  S3Server server;
  ~Running() {
    kill(pid, SIGKILL);
    waitpid(pid, nullptr, 0);
  }
};
std::unique_ptr<Running> running;

class StopS3AtEnd : public ::testing::Environment {
 public:
  void TearDown() override { running.reset(); }
};
const auto* const kStopS3AtEnd = ::testing::AddGlobalTestEnvironment(new StopS3AtEnd);

// Starts the program and returns its first line, which is empty if it ended.
std::string start(const std::string& folder, pid_t& pid) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) throw std::runtime_error("no pipe");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_addclose(&actions, ends[0]);
  std::string program = STRATA_SOURCE_DIR "/tests/e2e/s3/serve", argument = folder;
  std::array<char*, 3> words{program.data(), argument.data(), nullptr};
  const int failed = posix_spawn(&pid, program.c_str(), &actions, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  const std::unique_ptr<FILE, int (*)(FILE*)> out(fdopen(ends[0], "r"), &fclose);
  if (failed != 0) throw std::runtime_error("not started: " + program);
  std::array<char, 100> line{};
  return fgets(line.data(), line.size(), out.get()) ? line.data() : "";
}

void curl(const std::string& words) {
  const std::string command = "curl --silent --show-error --fail --output /dev/null " + words;
  if (std::system(command.c_str()) != 0) throw std::runtime_error(command);  // NOLINT: fixed words
}

}  // namespace

const S3Server* shared_s3() {
  if (running) return &running->server;
  auto fresh = std::make_unique<Running>();
  const std::string line = start(fresh->folder.path().string() + "/swift", fresh->pid);
  const auto space = line.find(' ');
  if (space == std::string::npos) return nullptr;
  const std::string local = "http://127.0.0.1:";
  fresh->server.endpoint = local + line.substr(0, space);
  fresh->server.unchecked =
      local + line.substr(space + 1, line.find('\n') - space - 1) + "/v1/AUTH_museum/strata";
  setenv("AWS_ACCESS_KEY_ID", "museum:strata", 1);
  setenv("AWS_SECRET_ACCESS_KEY", "a-secret-key-of-the-tests", 1);
  setenv("AWS_REGION", "us-east-1", 1);
  running = std::move(fresh);
  return &running->server;
}

void replace_object(const std::string& key, const std::string& content) {
  const auto file = running->folder.path() / "object";
  std::ofstream(file, std::ios::binary) << content;
  curl("--upload-file " + file.string() + " " + running->server.unchecked + "/" + key);
}

void delete_object(const std::string& key) {
  curl("--request DELETE " + running->server.unchecked + "/" + key);
}

}  // namespace strata::test
