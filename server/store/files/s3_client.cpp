#include "store/files/s3_client.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <thread>
#include <utility>

#include "core/progress.h"
#include "core/text/hex.h"
#include "core/text/url.h"

namespace strata::store {
namespace {

constexpr int kTries = 3, kTriesOfRead = 2;
constexpr std::size_t kBytesPerMs = 64;  // slower transfers end
constexpr std::chrono::milliseconds kFirstPause{200};
constexpr std::size_t kMaxIdle = 8;

// The body of a request and of its reply.
struct Transfer {
  Bytes memory;  // not yet sent
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file{nullptr, &std::fclose};
  std::uint64_t left_in_file = 0;
  bool has_changed = false;  // the file is shorter than it was, or can no longer be read
  const std::function<bool()>* cancelled = nullptr;
  std::vector<std::uint8_t> reply;
  std::size_t max_reply = 0;
  bool is_too_long = false;
};

std::size_t read_body(char* to, std::size_t size, std::size_t count, void* context) {
  auto& transfer = *static_cast<Transfer*>(context);
  if (transfer.file) {
    const auto wanted =
        static_cast<std::size_t>(std::min<std::uint64_t>(size * count, transfer.left_in_file));
    const std::size_t read = std::fread(to, 1, wanted, transfer.file.get());
    transfer.left_in_file -= read;
    // curl would wait for the rest of the file.
    transfer.has_changed = read < wanted;
    return transfer.has_changed ? CURL_READFUNC_ABORT : read;
  }
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

bool may_pass(const S3Reply& reply) {
  constexpr std::string_view kTimeout = "<Code>RequestTimeout</Code>";
  return reply.status == 408 || reply.status == 429 || reply.status >= 500 ||
         (reply.status == 400 && std::search(reply.body.begin(), reply.body.end(), kTimeout.begin(),
                                             kTimeout.end()) != reply.body.end());
}

}  // namespace

S3Client::S3Client(S3Bucket bucket, S3Patience patience)
    : bucket_(std::move(bucket)), patience_(patience) {
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
  curl_easy_setopt(handle, CURLOPT_CONNECTTIMEOUT_MS, patience_.connect_ms);
  curl_easy_setopt(handle, CURLOPT_LOW_SPEED_LIMIT, 1L);
  curl_easy_setopt(handle, CURLOPT_LOW_SPEED_TIME, patience_.silent_s);
  const std::size_t most_bytes = call.body ? std::size_t(call.body->bytes) : call.max_reply;
  curl_easy_setopt(handle, CURLOPT_TIMEOUT_MS,
                   patience_.whole_ms + static_cast<long>(most_bytes / kBytesPerMs));
  if (is_loopback_url(bucket_.url)) curl_easy_setopt(handle, CURLOPT_PROXY, "");
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
      transfer.left_in_file = static_cast<std::uint64_t>(call.body->bytes);
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
  if (transfer.has_changed)
    return fail(ErrorCode::conflict, "File changed",
                "The file changed while it was sent. Send it again.", "source_files");
  if (code == CURLE_ABORTED_BY_CALLBACK) return cancelled_problem();
  if (transfer.is_too_long) return no_answer(bucket_.url, "its reply is too long");
  if (code != CURLE_OK) return no_answer(bucket_.url, curl_easy_strerror(code));
  S3Reply reply;
  curl_easy_getinfo(handle.get(), CURLINFO_RESPONSE_CODE, &reply.status);
  reply.body = std::move(transfer.reply);
  keep_handle(std::move(handle));
  return reply;
}

int S3Client::tries_now(const S3Call& call) {
  const bool is_read = call.method == S3Call::Method::get || call.method == S3Call::Method::head;
  const std::lock_guard lock(mutex_);
  if (!down_until_) return is_read ? kTriesOfRead : kTries;
  const auto now = std::chrono::steady_clock::now();
  if (now < *down_until_) return 0;
  down_until_ = now + patience_.down;  // others do not try at the same time
  return 1;
}

void S3Client::note_answer(bool has_answered) {
  const std::lock_guard lock(mutex_);
  if (has_answered)
    down_until_.reset();
  else
    down_until_ = std::chrono::steady_clock::now() + patience_.down;
}

Result<S3Reply> S3Client::send(const S3Call& call, const std::function<bool()>& cancelled) {
  const int tries = tries_now(call);
  if (tries == 0) return no_answer(bucket_.url, "it did not answer a moment ago");
  auto pause = kFirstPause;
  for (int tries_left = tries - 1;; --tries_left) {
    auto reply = send_once(call, cancelled);
    const bool is_silent = !reply && reply.error().code == ErrorCode::unavailable;
    if (reply || (is_silent && tries_left == 0)) note_answer(reply.has_value());
    const bool again = reply ? may_pass(*reply) : is_silent;
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
