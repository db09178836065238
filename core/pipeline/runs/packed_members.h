// Plain structs as bytes and back, bit by bit. How many members a struct has is said once (kMembers); with another
// number of them it does not compile, so that none is forgotten. A description of the types goes with the bytes: what
// was written of other structs is not taken for these.
#pragma once

#include "core/base/error.h"
#include "core/base/text_sink.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace evical::packed {

static_assert(std::endian::native == std::endian::little, "the files are little endian");

template <class Struct>
inline constexpr int kMembers = 0;
// The last enumerator: larger numbers are damage.
template <class Enum>
inline constexpr Enum kLast = Enum{};

template <class Struct>
auto membersOf(Struct& s) {
  constexpr int kCount = kMembers<std::remove_const_t<Struct>>;
  static_assert(kCount > 0 && kCount <= 18, "say in kMembers how many members it has");
  // clang-format off
  if constexpr (kCount == 2) { auto& [a, b] = s; return std::tie(a, b); }
  else if constexpr (kCount == 3) { auto& [a, b, c] = s; return std::tie(a, b, c); }
  else if constexpr (kCount == 4) { auto& [a, b, c, d] = s; return std::tie(a, b, c, d); }
  else if constexpr (kCount == 5) { auto& [a, b, c, d, e] = s; return std::tie(a, b, c, d, e); }
  else if constexpr (kCount == 6) { auto& [a, b, c, d, e, f] = s; return std::tie(a, b, c, d, e, f); }
  else if constexpr (kCount == 7) { auto& [a, b, c, d, e, f, g] = s; return std::tie(a, b, c, d, e, f, g); }
  else if constexpr (kCount == 8) { auto& [a, b, c, d, e, f, g, h] = s; return std::tie(a, b, c, d, e, f, g, h); }
  else if constexpr (kCount == 9) { auto& [a, b, c, d, e, f, g, h, i] = s; return std::tie(a, b, c, d, e, f, g, h, i); }
  else if constexpr (kCount == 10) { auto& [a, b, c, d, e, f, g, h, i, j] = s; return std::tie(a, b, c, d, e, f, g, h, i, j); }
  else if constexpr (kCount == 11) { auto& [a, b, c, d, e, f, g, h, i, j, k] = s; return std::tie(a, b, c, d, e, f, g, h, i, j, k); }
  else if constexpr (kCount == 12) { auto& [a, b, c, d, e, f, g, h, i, j, k, l] = s; return std::tie(a, b, c, d, e, f, g, h, i, j, k, l); }
  else if constexpr (kCount == 13) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m] = s; return std::tie(a, b, c, d, e, f, g, h, i, j, k, l, m); }
  else if constexpr (kCount == 17) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r] = s; return std::tie(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r); }
  else { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, t] = s; return std::tie(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, t); }
  // clang-format on
}

// What is not kept: every run takes it from its session anew.
template <class T>
inline constexpr bool kLeftOut = false;

class Packing {
 public:
  // Hands bytes on, a piece at a time; the last with flush.
  explicit Packing(const TextSink& sink) : sink_(sink) {}

  void flush() {
    sink_(bytes_);
    bytes_.clear();
  }

  void pack(const std::string& text) {
    count(text.size());
    append(text.data(), text.size());
  }
  template <class T>
  void pack(const std::vector<T>& values) {
    count(values.size());
    for (const T& value : values) pack(value);
  }
  template <class T, std::size_t Size>
  void pack(const std::array<T, Size>& values) {
    for (const T& value : values) pack(value);
  }
  template <class T>
  void pack(const std::optional<T>& value) {
    pack(value.has_value());
    if (value) pack(*value);
  }
  template <class T, int Rows, int Cols>
  void pack(const Eigen::Matrix<T, Rows, Cols>& matrix) {
    if constexpr (Rows == Eigen::Dynamic) count(static_cast<std::size_t>(matrix.rows()));
    if constexpr (Cols == Eigen::Dynamic) count(static_cast<std::size_t>(matrix.cols()));
    append(matrix.data(), sizeof(T) * static_cast<std::size_t>(matrix.size()));
  }
  void pack(const Eigen::Quaterniond& rotation) { append(rotation.coeffs().data(), 4 * sizeof(double)); }
  template <class T>
  void pack(const T& value) {
    if constexpr (kLeftOut<T>) {
      static_cast<void>(value);
    } else if constexpr (std::is_enum_v<T>) {
      const auto byte = static_cast<char>(value);
      append(&byte, 1);
    } else if constexpr (std::is_arithmetic_v<T>) {
      append(&value, sizeof value);
    } else {
      std::apply([&](const auto&... member) { (pack(member), ...); }, membersOf(value));
    }
  }

 private:
  void append(const void* data, std::size_t size) {
    constexpr std::size_t kPiece_bytes = 1 << 16;
    bytes_.append(static_cast<const char*>(data), size);
    if (bytes_.size() >= kPiece_bytes) flush();
  }
  void count(std::size_t number) { pack(static_cast<std::uint64_t>(number)); }

  const TextSink& sink_;
  std::string bytes_;  // not handed on yet
};

// Throws CalibrationError (BadInput) where bytes end too early or are no value of their type.
class Unpacking {
 public:
  explicit Unpacking(std::string_view bytes) : bytes_(bytes) {}

  bool atEnd() const { return bytes_.empty(); }

  void unpack(std::string& text) { text = std::string(take(count(1))); }
  template <class T>
  void unpack(std::vector<T>& values) {
    values.clear();
    for (std::size_t left = count(kLeastSize); left > 0; --left) unpack(values.emplace_back());
  }
  template <class T, std::size_t Size>
  void unpack(std::array<T, Size>& values) {
    for (T& value : values) unpack(value);
  }
  template <class T>
  void unpack(std::optional<T>& value) {
    const char there = take(1).front();
    if (there != '\0' && there != '\1') throw damaged();
    value.reset();
    if (there == '\1') unpack(value.emplace());
  }
  template <class T, int Rows, int Cols>
  void unpack(Eigen::Matrix<T, Rows, Cols>& matrix) {
    if constexpr (Rows == Eigen::Dynamic || Cols == Eigen::Dynamic) {
      const auto rows = Rows == Eigen::Dynamic ? static_cast<Eigen::Index>(count(0)) : Eigen::Index{Rows};
      const auto cols = Cols == Eigen::Dynamic ? static_cast<Eigen::Index>(count(0)) : Eigen::Index{Cols};
      if (rows > 0 &&
          static_cast<std::size_t>(cols) > bytes_.size() / sizeof(T) / static_cast<std::size_t>(rows))
        throw damaged();
      matrix.resize(rows, cols);
    }
    const std::string_view from = take(sizeof(T) * static_cast<std::size_t>(matrix.size()));
    if (!from.empty()) std::memcpy(matrix.data(), from.data(), from.size());
  }
  void unpack(Eigen::Quaterniond& rotation) {
    std::memcpy(rotation.coeffs().data(), take(4 * sizeof(double)).data(), 4 * sizeof(double));
  }
  template <class T>
  void unpack(T& value) {
    if constexpr (kLeftOut<T>) {
      value = {};
    } else if constexpr (std::is_enum_v<T>) {
      const auto number = static_cast<unsigned char>(take(1).front());
      if (number > static_cast<unsigned char>(kLast<T>)) throw damaged();
      value = static_cast<T>(number);
    } else if constexpr (std::is_same_v<T, bool>) {
      const char number = take(1).front();
      if (number != '\0' && number != '\1') throw damaged();
      value = number == '\1';
    } else if constexpr (std::is_arithmetic_v<T>) {
      std::memcpy(&value, take(sizeof value).data(), sizeof value);
    } else {
      std::apply([&](auto&... member) { (unpack(member), ...); }, membersOf(value));
    }
  }

  static CalibrationError damaged() { return badInput("", "is damaged"); }

 private:
  static constexpr std::size_t kLeastSize = 8;  // of what is kept in lists: no list claims more than there is

  std::string_view take(std::size_t size) {
    if (size > bytes_.size()) throw damaged();
    const std::string_view taken = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return taken;
  }
  std::size_t count(std::size_t of_bytes) {
    std::uint64_t number = 0;
    std::memcpy(&number, take(sizeof number).data(), sizeof number);
    if (number > bytes_.size() / std::max<std::size_t>(of_bytes, 1)) throw damaged();
    return static_cast<std::size_t>(number);
  }

  std::string_view bytes_;
};

template <class T>
struct Described {
  static void add(std::string& text) {
    if constexpr (kLeftOut<T>) {
      text += '-';
    } else if constexpr (std::is_enum_v<T>) {
      text += 'e' + std::to_string(static_cast<int>(kLast<T>));
    } else if constexpr (std::is_arithmetic_v<T>) {
      text += (std::is_floating_point_v<T> ? 'f'
               : std::is_signed_v<T>       ? 'i'
                                           : 'u') +
              std::to_string(sizeof(T));
    } else {
      text += '(';
      T some{};
      std::apply([&](auto&... member) { (Described<std::remove_cvref_t<decltype(member)>>::add(text), ...); },
                 membersOf(some));
      text += ')';
    }
  }
};
template <>
struct Described<std::string> {
  static void add(std::string& text) { text += 's'; }
};
template <>
struct Described<Eigen::Quaterniond> {
  static void add(std::string& text) { text += 'q'; }
};
template <class T>
struct Described<std::vector<T>> {
  static void add(std::string& text) {
    text += '*';
    Described<T>::add(text);
  }
};
template <class T>
struct Described<std::optional<T>> {
  static void add(std::string& text) {
    text += '?';
    Described<T>::add(text);
  }
};
template <class T, std::size_t Size>
struct Described<std::array<T, Size>> {
  static void add(std::string& text) {
    text += std::to_string(Size) + 'x';
    Described<T>::add(text);
  }
};
template <class T, int Rows, int Cols>
struct Described<Eigen::Matrix<T, Rows, Cols>> {
  static void add(std::string& text) { text += 'm' + std::to_string(Rows) + ',' + std::to_string(Cols); }
};

// The types of a struct's members, and of theirs.
template <class T>
std::string description() {
  std::string text;
  Described<T>::add(text);
  return text;
}

}  // namespace evical::packed
