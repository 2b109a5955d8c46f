#pragma once

#include <curl/curl.h>

#include <functional>
#include <memory>
#include <mutex>
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

// Sends requests to a bucket, signed by libcurl (AWS Signature Version 4). Repeats a request up to
// three times after temporary failures. A request ends when no byte was sent or received for 30
// seconds. Thread-safe.
class S3Client {
 public:
  explicit S3Client(S3Bucket bucket);
  // Also returns replies with an error status such as 404. Returns `unavailable` if the server
  // cannot be reached, or replies with the status 429 or 5xx.
  Result<S3Reply> send(const S3Call& call, const std::function<bool()>& cancelled = {});

 private:
  struct CloseHandle {
    void operator()(CURL* handle) const { curl_easy_cleanup(handle); }
    void operator()(curl_slist* list) const { curl_slist_free_all(list); }
  };
  using Handle = std::unique_ptr<CURL, CloseHandle>;
  using Headers = std::unique_ptr<curl_slist, CloseHandle>;

  Result<S3Reply> send_once(const S3Call& call, const std::function<bool()>& cancelled);
  void set_up(CURL* handle, const S3Call& call);
  Handle take_handle();
  void keep_handle(Handle handle);

  const S3Bucket bucket_;
  std::mutex mutex_;
  std::vector<Handle> idle_;  // with open connections
};

}  // namespace strata::store
