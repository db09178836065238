// Structs as HDF5 datasets and back, bit by bit: a group for each struct, a dataset for each of its fields. Of a list of
// structs each field is one column over all of them. What a file lacks of a struct keeps its default.
#pragma once

#include "core/base/error.h"
#include "core/format/hdf5_content.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace evical::columns {

// The names and members of a struct.
template <class Struct>
struct Fields;

// clang-format off
#define EVICAL_ONCE(...) __VA_ARGS__
#define EVICAL_THRICE(...) EVICAL_ONCE(EVICAL_ONCE(EVICAL_ONCE(__VA_ARGS__)))
#define EVICAL_OFTEN(...) EVICAL_THRICE(EVICAL_THRICE(EVICAL_THRICE(EVICAL_THRICE(__VA_ARGS__))))
#define EVICAL_PARENTHESES ()
#define EVICAL_NEXT() EVICAL_EACH
#define EVICAL_EACH(NAME, ...) \
  std::pair{#NAME, &Struct::NAME} __VA_OPT__(, EVICAL_NEXT EVICAL_PARENTHESES (__VA_ARGS__))
// EVICAL_FIELDS(struct, its members in their order): a struct that grows does not compile until its new member is here.
#define EVICAL_FIELDS(STRUCT, ...)                                         \
  template <>                                                              \
  struct Fields<STRUCT> {                                                  \
    using Struct = STRUCT;                                                 \
    static constexpr std::tuple kAll{EVICAL_OFTEN(EVICAL_EACH(__VA_ARGS__))}; \
    static void areAll(const Struct& all) {                                \
      const auto& [__VA_ARGS__] = all;                                     \
      static_cast<void>(std::tie(__VA_ARGS__));                            \
    }                                                                      \
  }
// clang-format on

// The last enumerator: larger numbers are damage.
template <class Enum>
inline constexpr Enum kLast = Enum{};

// What is not kept: every run takes it from its session anew.
template <class T>
inline constexpr bool kLeftOut = false;

// How many numbers a value of fixed size has; 0: it is none.
template <class T>
inline constexpr int kWidth = 0;
template <class T, std::size_t Size>
inline constexpr int kWidth<std::array<T, Size>> = static_cast<int>(Size);
template <class T, int Rows, int Cols>
inline constexpr int kWidth<Eigen::Matrix<T, Rows, Cols>> = Rows > 0 && Cols > 0 ? Rows* Cols : 0;
template <>
inline constexpr int kWidth<Eigen::Quaterniond> = 4;

template <class T>
inline constexpr bool kIsNumber = std::is_arithmetic_v<T> || std::is_enum_v<T>;
template <class T>
concept Listed = requires(T& value) {
  value.push_back(value.front());
}
&&!std::is_same_v<T, std::string>;
template <class T>
concept Optional = requires(T& value) {
  value.emplace();
  value.has_value();
}
&&!Listed<T>;
template <class T>
concept DynamicMatrix = requires(T& value) {
  value.resize(value.rows(), value.cols());
}
&&kWidth<T> == 0;

// As what a column holds numbers or texts.
template <class T>
using Stored = std::conditional_t<std::is_same_v<T, std::string>, std::string,
                                  std::conditional_t<std::is_floating_point_v<T>, double, std::int64_t>>;

inline CalibrationError damaged() {
  return badInput("", "is damaged");
}

class Writer {
 public:
  static constexpr bool kReads = false;
  explicit Writer(const Hdf5Sink& sink) : sink_(sink) {}

  template <class T>
  bool column(const std::string& path, std::size_t width, const std::vector<T*>& values) const {
    std::vector<Stored<std::remove_const_t<T>>> stored;
    stored.reserve(values.size());
    for (const T* value : values) stored.push_back(static_cast<Stored<std::remove_const_t<T>>>(*value));
    std::vector<std::size_t> shape = {values.size() / width};
    if (width > 1) shape.push_back(width);
    sink_({path, std::move(shape), std::move(stored), true});
    return true;
  }

 private:
  const Hdf5Sink& sink_;
};

// Throws CalibrationError (BadInput) where a column is no value of its type.
class Reader {
 public:
  static constexpr bool kReads = true;
  // No list claims to be longer than `most`.
  Reader(const Hdf5Source& source, std::size_t most) : source_(source), most_(most) {}

  // False where there is none.
  template <class T>
  bool column(const std::string& path, std::size_t, const std::vector<T*>& values) const {
    const std::optional<Hdf5Dataset> found = source_(path);
    if (!found) return false;
    const auto* const stored = std::get_if<std::vector<Stored<T>>>(&found->data);
    if (stored == nullptr || stored->size() != values.size()) throw damaged();
    for (std::size_t k = 0; k < values.size(); ++k) *values[k] = valueOf<T>((*stored)[k]);
    return true;
  }

  // Of lists, or of matrices' columns by so many rows.
  void checkSizes(const std::vector<std::int64_t>& sizes, std::int64_t rows = 1) const {
    std::int64_t left = static_cast<std::int64_t>(most_) / std::max<std::int64_t>(rows, 1);
    for (const std::int64_t size : sizes)
      if (rows < 0 || size < 0 || (left -= std::min(size, left + 1)) < 0) throw damaged();
  }

 private:
  template <class T>
  static T valueOf(const Stored<T>& stored) {
    if constexpr (std::is_same_v<T, std::string> || std::is_floating_point_v<T>) {
      return stored;
    } else if constexpr (std::is_enum_v<T>) {
      if (stored < 0 || stored > static_cast<std::int64_t>(kLast<T>)) throw damaged();
      return static_cast<T>(stored);
    } else if constexpr (std::is_same_v<T, bool>) {
      if (stored < 0 || stored > 1) throw damaged();
      return stored == 1;
    } else {
      if (!std::in_range<T>(stored)) throw damaged();
      return static_cast<T>(stored);
    }
  }

  const Hdf5Source& source_;
  std::size_t most_;
};

template <class Io, class T>
bool visit(Io& io, const std::string& path, const std::vector<T*>& values);

template <class Io>
bool visitSizes(Io& io, const std::string& path, std::vector<std::int64_t>& sizes) {
  std::vector<std::int64_t*> each;
  for (std::int64_t& size : sizes) each.push_back(&size);
  return io.column(path, 1, each);
}

// The numbers of all of them, in the order in which Eigen has them.
template <class T>
auto numbersOf(const std::vector<T*>& values) {
  if constexpr (std::is_same_v<std::remove_const_t<T>, Eigen::Quaterniond>) {
    std::vector<decltype(&values.front()->coeffs())> coefficients;
    for (T* const value : values) coefficients.push_back(&value->coeffs());
    return numbersOf(coefficients);
  } else {
    std::vector<decltype(values.front()->data())> numbers;
    for (T* const value : values)
      for (decltype(value->size()) k = 0; k < value->size(); ++k) numbers.push_back(value->data() + k);
    return numbers;
  }
}

template <class Io, class T>
bool visitMatrices(Io& io, const std::string& path, const std::vector<T*>& values) {
  std::vector<std::int64_t> rows, columns;
  for (const T* value : values) {
    rows.push_back(value->rows());
    columns.push_back(value->cols());
  }
  if (!visitSizes(io, path + "/rows", rows) || !visitSizes(io, path + "/columns", columns)) return false;
  if constexpr (Io::kReads)
    for (std::size_t k = 0; k < values.size(); ++k) {
      io.checkSizes({columns[k]}, rows[k]);
      if (T::ColsAtCompileTime > 0 && columns[k] != T::ColsAtCompileTime) throw damaged();
      values[k]->resize(rows[k], columns[k]);
    }
  const auto numbers = numbersOf(values);
  return numbers.empty() || io.column(path + "/values", 1, numbers);
}

template <class T>
auto itemsOf(const std::vector<T*>& values) {
  if constexpr (Optional<std::remove_const_t<T>>) {
    std::vector<decltype(&**values.front())> items;
    for (T* const value : values)
      if (value->has_value()) items.push_back(&**value);
    return items;
  } else {
    std::vector<decltype(&values.front()->front())> items;
    for (T* const value : values)
      for (auto& item : *value) items.push_back(&item);
    return items;
  }
}

// Lists, and optional values as lists of one or none.
template <class Io, class T>
bool visitLists(Io& io, const std::string& path, const std::vector<T*>& values) {
  constexpr bool kOptional = Optional<std::remove_const_t<T>>;
  std::vector<std::int64_t> sizes;
  for (const T* value : values) {
    if constexpr (kOptional)
      sizes.push_back(value->has_value() ? 1 : 0);
    else
      sizes.push_back(static_cast<std::int64_t>(value->size()));
  }
  if (!visitSizes(io, path + "/count", sizes)) return false;
  if constexpr (Io::kReads) {
    io.checkSizes(sizes);
    for (std::size_t k = 0; k < values.size(); ++k) {
      if constexpr (!kOptional)
        values[k]->resize(static_cast<std::size_t>(sizes[k]));
      else if (sizes[k] > 1)
        throw damaged();
      else if (sizes[k] == 1)
        values[k]->emplace();
      else
        values[k]->reset();
    }
  }
  const auto items = itemsOf(values);
  using Item = std::remove_cvref_t<decltype(*items.front())>;
  if (items.empty()) return true;
  if constexpr (requires { Fields<Item>::kAll; })
    return visit(io, path, items);
  else if (!visit(io, path + "/values", items))
    throw damaged();
  return true;
}

// One column, or several below `path`. False where there is none to be read.
template <class Io, class T>
bool visit(Io& io, const std::string& path, const std::vector<T*>& values) {
  using Value = std::remove_const_t<T>;
  if constexpr (kLeftOut<Value>) {
    return true;
  } else if constexpr (kIsNumber<Value> || std::is_same_v<Value, std::string>) {
    return io.column(path, 1, values);
  } else if constexpr (kWidth<Value> > 0) {
    return io.column(path, static_cast<std::size_t>(kWidth<Value>), numbersOf(values));
  } else if constexpr (DynamicMatrix<Value>) {
    return visitMatrices(io, path, values);
  } else if constexpr (Listed<Value> || Optional<Value>) {
    return visitLists(io, path, values);
  } else {
    const auto field = [&](const auto& named) {
      std::vector<decltype(&(values.front()->*named.second))> members;
      members.reserve(values.size());
      for (T* const value : values) members.push_back(&(value->*named.second));
      visit(io, path + "/" + named.first, members);
    };
    std::apply([&](const auto&... named) { (field(named), ...); }, Fields<Value>::kAll);
    return true;
  }
}

template <class T>
void write(const std::string& path, const T& value, const Hdf5Sink& sink) {
  const Writer writer(sink);
  visit(writer, path, std::vector{&value});
}

// Throws CalibrationError (BadInput) where this is no such value; `most`: no list claims to be longer.
template <class T>
void read(const std::string& path, T& value, const Hdf5Source& source, std::size_t most) {
  const Reader reader(source, most);
  visit(reader, path, std::vector{&value});
}

}  // namespace evical::columns
