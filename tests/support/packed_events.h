// Encoders of formats that cameras write and Evical only reads, for files of tests and benchmarks.
#pragma once

#include "core/data/event.h"

#include <cstdint>
#include <string>
#include <vector>

namespace evical::test {

// The data after the header; times are truncated to us, events must be in order of time.
std::string encodeEvt2(EventSpan events);
std::string encodeEvt21(EventSpan events, bool halves_exchanged);
std::string encodeEvt3(EventSpan events);  // events of one row, time and polarity as vectors
std::string encodeDat(EventSpan events);   // with the two bytes in front
std::string encodeEventStream(EventSpan events, int height_px, bool atis);

// "Event Stream" and what follows it.
std::string eventStreamHeader(int width_px, int height_px, bool atis);

template <class Word>
void appendWord(std::string& bytes, Word word) {
  bytes.append(reinterpret_cast<const char*>(&word), sizeof word);
}

}  // namespace evical::test
