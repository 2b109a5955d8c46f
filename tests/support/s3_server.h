#pragma once

#include <string>

namespace strata::test {

// An S3 server for tests (tests/e2e/s3), which this program starts at first use and ends at its
// end. Link strata_s3_support.
struct S3Server {
  std::string endpoint;   // http://127.0.0.1:PORT
  std::string unchecked;  // the address of the bucket `strata` without signatures
};
// Returns null if Swift is not installed. The environment has the keys then.
const S3Server* shared_s3();

// Replaces the content of an object, or deletes it, without the knowledge of Strata.
void replace_object(const std::string& key, const std::string& content);
void delete_object(const std::string& key);

}  // namespace strata::test
