#pragma once

#include "store/files/file_store.h"
#include "store/files/s3_client.h"

namespace strata::store {

// The variables of the environment that all programs for S3 use.
struct S3Environment {
  std::string access_key, secret_key, session_token;  // AWS_ACCESS_KEY_ID, AWS_SECRET_ACCESS_KEY, …
  std::string region;                                 // AWS_REGION or AWS_DEFAULT_REGION
  std::string endpoint;                               // AWS_ENDPOINT_URL_S3 or AWS_ENDPOINT_URL
  std::string ca_file;                                // AWS_CA_BUNDLE
};
S3Environment s3_environment();

// Returns the bucket of s3://BUCKET/PREFIX. The address of another server must use https, unless
// the server runs on this machine.
struct S3Place {
  S3Bucket bucket;
  std::string prefix;  // empty, or with a slash at the end
};
Result<S3Place> s3_place(const FilesPlace& place, const S3Environment& environment);

// One page of the reply to ListObjectsV2.
struct S3Page {
  std::vector<StoredFile> files;  // only files whose names are hashes
  std::string last_key;           // of all names; empty for an empty page
  bool is_last = true;
};
Result<S3Page> read_s3_page(std::string_view xml, std::string_view prefix);

// Content in a bucket of an S3 server. The server checks the hash of each upload. An upload is one
// request, which succeeds as a whole or not at all.
class S3Files : public FileStore {
 public:
  // `page_size` is the number of names in one reply to `list`.
  static Result<std::unique_ptr<FileStore>> open(const FilesPlace& place,
                                                 const S3Environment& environment,
                                                 int page_size = 1000);

  std::string place() const override { return place_; }
  std::uint64_t max_bytes() const override { return std::uint64_t{5} << 30; }  // limit of S3
  Result<void> put(const Content& content, const std::function<bool()>& cancelled) override;
  Result<std::vector<std::uint8_t>> read(const Sha256& hash, std::uint64_t begin,
                                         std::size_t size) override;
  Result<bool> remove(const Sha256& hash) override;
  Result<void> list(const std::function<Result<void>(const StoredFile&)>& visit) override;
  Result<void> remove_unfinished(std::chrono::seconds) override { return {}; }
  Result<std::optional<std::string>> read_mark() override;
  Result<void> write_mark(const std::string& text) override;

 private:
  S3Files(std::string place, S3Place there, int page_size)
      : place_(std::move(place)),
        prefix_(std::move(there.prefix)),
        page_size_(page_size),
        client_(there.bucket) {}
  std::string key_of(const Sha256& hash) const { return prefix_ + file_name_of(hash); }
  Result<void> put_object(const std::string& key, const Content& content,
                          const std::function<bool()>& cancelled);

  const std::string place_;
  const std::string prefix_;
  const int page_size_;
  S3Client client_;
};

}  // namespace strata::store
