#pragma once

#include <string>

namespace strata::store {

// Where the content outside the database is.
struct FilesPlace {
  std::string place;     // a folder, or s3://BUCKET/PREFIX; empty: all content is in the database
  std::string endpoint;  // of an S3 server that is not Amazon's: https://HOST:PORT; may be empty
};

}  // namespace strata::store
