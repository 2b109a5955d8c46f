#pragma once

namespace strata {

// A sum of doubles that compensates rounding errors (Neumaier 1974, with the branch-free step of
// Knuth, TAOCP 2, 4.2.2). It is as precise as a sum with twice as many digits, for numbers of any
// size and in any order. Accepts only finite numbers.
class CompensatedSum {
 public:
  CompensatedSum(double value = 0) : sum_(value) {}

  CompensatedSum& operator+=(double value) {
    const double sum = sum_ + value, added = sum - sum_;
    lost_ += (sum_ - (sum - added)) + (value - added);
    sum_ = sum;
    return *this;
  }
  CompensatedSum& operator+=(const CompensatedSum& other) {
    *this += other.sum_;
    lost_ += other.lost_;
    return *this;
  }
  double value() const { return sum_ + lost_; }

 private:
  double sum_, lost_ = 0;
};

}  // namespace strata
