#pragma once

#include <string>

namespace strata::test {

// An S3 server for tests (tests/e2e/s3). The test program starts it at the first use, and stops it
// when the program ends. Link strata_s3_support.
struct S3Server {
  std::string endpoint;   // http://127.0.0.1:PORT
  std::string unchecked;  // the address of the bucket `strata` without signatures
};
// Sets the environment variables with the keys. Returns null if Swift is not installed.
const S3Server* shared_s3();

// Replaces the content of an object, or deletes it, directly in the store.
void replace_object(const std::string& key, const std::string& content);
void delete_object(const std::string& key);

}  // namespace strata::test
