#include "store/files/s3_client.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <thread>
#include <utility>

#include "core/progress.h"
#include "core/text/hex.h"

namespace strata::store {
namespace {

constexpr long kS3Connect_ms = 5000;
constexpr long kSilent_s = 30;  // without a byte
constexpr int kTries = 3;
constexpr std::chrono::milliseconds kFirstPause{200};
constexpr std::size_t kMaxIdle = 8;

// The body of a request and of its reply.
struct Transfer {
  Bytes memory;  // not yet sent
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file{nullptr, &std::fclose};
  const std::function<bool()>* cancelled = nullptr;
  std::vector<std::uint8_t> reply;
  std::size_t max_reply = 0;
  bool is_too_long = false;
};

std::size_t read_body(char* to, std::size_t size, std::size_t count, void* context) {
  auto& transfer = *static_cast<Transfer*>(context);
  if (transfer.file) return std::fread(to, 1, size * count, transfer.file.get());
  const std::size_t sent = std::min(size * count, transfer.memory.size());
  std::copy_n(transfer.memory.begin(), sent, to);
  transfer.memory = transfer.memory.subspan(sent);
  return sent;
}

std::size_t keep_reply(char* data, std::size_t size, std::size_t count, void* context) {
  auto& transfer = *static_cast<Transfer*>(context);
  transfer.is_too_long = transfer.reply.size() + size * count > transfer.max_reply;
  if (transfer.is_too_long) return 0;  // curl then ends the transfer
  transfer.reply.insert(transfer.reply.end(), data, data + size * count);
  return size * count;
}

int watch_transfer(void* context, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
  const auto& cancelled = *static_cast<Transfer*>(context)->cancelled;
  return cancelled && cancelled() ? 1 : 0;
}

tl::unexpected<Error> no_answer(const std::string& url, const std::string& why) {
  return fail(ErrorCode::unavailable, "Files unavailable",
              "The S3 server at " + url + " does not answer: " + why +
                  ". Nothing was changed. Try again later.",
              "--files");
}

bool may_pass(long status) { return status == 429 || status >= 500; }

}  // namespace

S3Client::S3Client(S3Bucket bucket) : bucket_(std::move(bucket)) {
  static std::once_flag initialized;
  std::call_once(initialized, [] { curl_global_init(CURL_GLOBAL_DEFAULT); });
}

S3Client::Handle S3Client::take_handle() {
  {
    const std::lock_guard lock(mutex_);
    if (!idle_.empty()) {
      Handle handle = std::move(idle_.back());
      idle_.pop_back();
      curl_easy_reset(handle.get());  // keeps the connection
      return handle;
    }
  }
  return Handle(curl_easy_init());
}

void S3Client::keep_handle(Handle handle) {
  const std::lock_guard lock(mutex_);
  if (idle_.size() < kMaxIdle) idle_.push_back(std::move(handle));
}

void S3Client::set_up(CURL* handle, const S3Call& call) {
  const std::string url =
      bucket_.url + "/" + call.key + (call.query.empty() ? "" : "?" + call.query);
  curl_easy_setopt(handle, CURLOPT_URL, url.c_str());
  curl_easy_setopt(handle, CURLOPT_PROTOCOLS_STR, "http,https");
  curl_easy_setopt(handle, CURLOPT_FOLLOWLOCATION, 0L);
  curl_easy_setopt(handle, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(handle, CURLOPT_CONNECTTIMEOUT_MS, kS3Connect_ms);
  curl_easy_setopt(handle, CURLOPT_LOW_SPEED_LIMIT, 1L);
  curl_easy_setopt(handle, CURLOPT_LOW_SPEED_TIME, kSilent_s);
  curl_easy_setopt(handle, CURLOPT_USERNAME, bucket_.access_key.c_str());
  curl_easy_setopt(handle, CURLOPT_PASSWORD, bucket_.secret_key.c_str());
  curl_easy_setopt(handle, CURLOPT_AWS_SIGV4, ("aws:amz:" + bucket_.region + ":s3").c_str());
  if (!bucket_.ca_file.empty()) curl_easy_setopt(handle, CURLOPT_CAINFO, bucket_.ca_file.c_str());
  if (!call.range.empty()) curl_easy_setopt(handle, CURLOPT_RANGE, call.range.c_str());
  if (call.method == S3Call::Method::head) curl_easy_setopt(handle, CURLOPT_NOBODY, 1L);
  if (call.method == S3Call::Method::remove)
    curl_easy_setopt(handle, CURLOPT_CUSTOMREQUEST, "DELETE");
}

Result<S3Reply> S3Client::send_once(const S3Call& call, const std::function<bool()>& cancelled) {
  Handle handle = take_handle();
  if (!handle) return no_answer(bucket_.url, "no memory for the request");
  set_up(handle.get(), call);
  Transfer transfer;
  transfer.max_reply = call.max_reply;
  transfer.cancelled = &cancelled;
  Sha256 body_hash = sha256(Bytes());
  if (call.method == S3Call::Method::put) {
    body_hash = call.body->hash;
    transfer.memory = call.body->memory;
    if (!call.body->file.empty()) {
      transfer.file.reset(std::fopen(call.body->file.c_str(), "rb"));
      if (!transfer.file)
        return fail(ErrorCode::internal, "File not readable",
                    "Cannot open " + call.body->file.string() + ".", "source_files");
    }
    curl_easy_setopt(handle.get(), CURLOPT_UPLOAD, 1L);
    curl_easy_setopt(handle.get(), CURLOPT_READFUNCTION, &read_body);
    curl_easy_setopt(handle.get(), CURLOPT_READDATA, &transfer);
    curl_easy_setopt(handle.get(), CURLOPT_INFILESIZE_LARGE,
                     static_cast<curl_off_t>(call.body->bytes));
  }
  // The server compares the body with this hash, so it refuses a body that has changed.
  Headers headers(
      curl_slist_append(nullptr, ("x-amz-content-sha256: " + to_hex(body_hash)).c_str()));
  if (!bucket_.session_token.empty())
    curl_slist_append(headers.get(), ("x-amz-security-token: " + bucket_.session_token).c_str());
  curl_easy_setopt(handle.get(), CURLOPT_HTTPHEADER, headers.get());
  curl_easy_setopt(handle.get(), CURLOPT_WRITEFUNCTION, &keep_reply);
  curl_easy_setopt(handle.get(), CURLOPT_WRITEDATA, &transfer);
  curl_easy_setopt(handle.get(), CURLOPT_NOPROGRESS, 0L);
  curl_easy_setopt(handle.get(), CURLOPT_XFERINFODATA, &transfer);
  curl_easy_setopt(handle.get(), CURLOPT_XFERINFOFUNCTION, &watch_transfer);
  const CURLcode code = curl_easy_perform(handle.get());
  if (code == CURLE_ABORTED_BY_CALLBACK) return cancelled_problem();
  if (transfer.is_too_long) return no_answer(bucket_.url, "its reply is too long");
  if (code != CURLE_OK) return no_answer(bucket_.url, curl_easy_strerror(code));
  S3Reply reply;
  curl_easy_getinfo(handle.get(), CURLINFO_RESPONSE_CODE, &reply.status);
  reply.body = std::move(transfer.reply);
  keep_handle(std::move(handle));
  return reply;
}

Result<S3Reply> S3Client::send(const S3Call& call, const std::function<bool()>& cancelled) {
  auto pause = kFirstPause;
  for (int tries_left = kTries - 1;; --tries_left) {
    auto reply = send_once(call, cancelled);
    const bool again =
        reply ? may_pass(reply->status) : reply.error().code == ErrorCode::unavailable;
    if (!again) return reply;
    if (tries_left == 0)
      return reply ? no_answer(bucket_.url,
                               "it answered with the status " + std::to_string(reply->status))
                   : std::move(reply);
    std::this_thread::sleep_for(pause);
    pause *= 4;
  }
}

}  // namespace strata::store
