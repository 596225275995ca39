#pragma once
#include <cstdint>
#include <cstring>
#include <string>

/// Bytes that are read one thing after another. After the first thing that does not fit everything read is zero or
/// empty.
namespace clutchwork::fmi {

class Reader {
 public:
  Reader(const unsigned char* from, std::int64_t bytes) : at_(from), end_(from + bytes) {}

  bool whole() const { return whole_; }
  const unsigned char* rest() const { return at_; }
  std::int64_t left() const { return end_ - at_; }
  bool is_at_end() const { return whole_ && at_ == end_; }

  /// A whole number within bounds.
  std::int64_t integer(std::int64_t low, std::int64_t high) {
    std::int64_t x = 0;
    take(&x);
    if (whole_ && x >= low && x <= high) return x;
    whole_ = false;
    return 0;
  }

  double number() {
    double x = 0;
    take(&x);
    return x;
  }

  /// How many things of at least so many bytes follow.
  std::int64_t count(std::int64_t each) { return integer(0, (end_ - at_) / each); }

  /// Bytes with their number before them, filled up to a multiple of eight.
  const unsigned char* bytes(std::int64_t* n) {
    *n = count(1);
    const unsigned char* found = at_;
    const std::int64_t filled = (*n + 7) / 8 * 8;
    if (filled > end_ - at_) whole_ = false, *n = 0;
    if (whole_) at_ += filled;
    return found;
  }

  std::string text() {
    std::int64_t n = 0;
    const unsigned char* found = bytes(&n);
    return std::string(reinterpret_cast<const char*>(found), std::size_t(n));
  }

 private:
  template <class X>
  void take(X* x) {
    if (!whole_ || end_ - at_ < 8) return void(whole_ = false);
    std::memcpy(x, at_, 8);
    at_ += 8;
  }

  const unsigned char *at_, *end_;
  bool whole_ = true;
};

}  // namespace clutchwork::fmi
