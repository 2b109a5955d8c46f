#pragma once

#include <curl/curl.h>

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/digest.h"
#include "core/error.h"
#include "store/files/content.h"

namespace strata::store {

// The address of a bucket, and the keys to access it. The keys are secrets: no error and no log
// contains them.
struct S3Bucket {
  std::string url;  // of the bucket, without a slash at the end
  std::string region;
  std::string access_key, secret_key, session_token;
  std::string ca_file;  // certificates to trust instead of the system's; may be empty
};

struct S3Call {
  enum class Method { get, head, put, remove };
  Method method = Method::get;
  std::string key{};              // the path in the bucket; only letters, digits and -._/
  std::string query{};            // sorted and percent-encoded
  std::string range{};            // for `get`: "0-99"
  const Content* body = nullptr;  // for `put`
  std::size_t max_reply = 1u << 20;
};

struct S3Reply {
  long status = 0;
  std::vector<std::uint8_t> body;
};

// How long the client waits. Tests use shorter times.
struct S3Patience {
  long connect_ms = 5000;
  long silent_s = 30;             // without a byte
  long whole_ms = 30'000;         // for a request, and a millisecond more for each 64 bytes
  std::chrono::seconds down{10};  // between two requests to a server that does not answer
};

// Sends requests to a bucket, signed by libcurl (AWS Signature Version 4). Repeats a request after
// temporary failures: sends a change up to three times, and a read, which somebody waits for,
// twice. If the server does not answer, later requests fail at once, except one each `down`, so
// they do not occupy all threads of the server. Thread-safe.
class S3Client {
 public:
  explicit S3Client(S3Bucket bucket, S3Patience patience = {});
  // Also returns replies with an error status such as 404. Returns `unavailable` if the server
  // cannot be reached, or replies with the status 408, 429 or 5xx. Returns `conflict` if the file
  // of the body becomes shorter.
  Result<S3Reply> send(const S3Call& call, const std::function<bool()>& cancelled = {});

 private:
  struct CloseHandle {
    void operator()(CURL* handle) const { curl_easy_cleanup(handle); }
    void operator()(curl_slist* list) const { curl_slist_free_all(list); }
  };
  using Handle = std::unique_ptr<CURL, CloseHandle>;
  using Headers = std::unique_ptr<curl_slist, CloseHandle>;

  int tries_now(const S3Call& call);  // 0: the server is down
  void note_answer(bool has_answered);
  Result<S3Reply> send_once(const S3Call& call, const std::function<bool()>& cancelled);
  void set_up(CURL* handle, const S3Call& call);
  Handle take_handle();
  void keep_handle(Handle handle);

  const S3Bucket bucket_;
  const S3Patience patience_;
  std::mutex mutex_;
  std::optional<std::chrono::steady_clock::time_point> down_until_;
  std::vector<Handle> idle_;  // with open connections
};

}  // namespace strata::store
