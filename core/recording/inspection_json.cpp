#include "core/recording/inspection_json.h"

#include <nlohmann/json.hpp>

namespace evical {
namespace {

using Json = nlohmann::ordered_json;

Json numbers(const Eigen::Vector3d& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

Json sizeJson(const Resolution& size_px) {
  return size_px.known() ? Json{size_px.width_px, size_px.height_px} : Json();
}

void addFrames(const StreamSummary& stream, Json& json) {
  const StreamInfo& info = stream.info;
  json.update(
      {{"resolution_px", sizeJson(info.resolution_px)}, {"readable", info.readable}, {"timed", info.timed}});
  if (stream.longest_exposure_s > 0.0)
    json["exposure_s"] = {stream.shortest_exposure_s, stream.longest_exposure_s};
}

Json streamJson(const StreamSummary& stream, bool with_checksums) {
  const StreamInfo& info = stream.info;
  Json json = {{"name", info.name},
               {"type", streamTypeName(info.type)},
               {"message", info.message},
               {"count", stream.count}};
  const bool frames = info.type == StreamType::Frames;
  if (frames) addFrames(stream, json);
  const bool timeless = frames && (!info.timed || !info.readable);
  if ((info.type != StreamType::Events && info.type != StreamType::Imu && !frames) || timeless) return json;
  if (info.type == StreamType::Events) json.update({{"on", stream.on}, {"off", stream.off}});
  json.update({{"first_ns", stream.first_ns},
               {"last_ns", stream.last_ns},
               {"rate_hz", stream.rate_hz},
               {"backward_steps", stream.backward_steps},
               {"largest_gap_ns", stream.largest_gap_ns}});
  if (info.type == StreamType::Imu) {
    json.update({{"acceleration_unit", stream.acceleration_unit},
                 {"angular_rate_unit", stream.angular_rate_unit},
                 {"median_acceleration", stream.median_acceleration},
                 {"mean_acceleration", numbers(stream.mean_acceleration)},
                 {"mean_angular_rate", numbers(stream.mean_angular_rate)}});
    return json;
  }
  if (frames) return json;
  json["resolution_px"] = sizeJson(info.resolution_px);
  if (info.host_clock_offset_s) json["host_clock_offset_s"] = *info.host_clock_offset_s;
  json["seen_px"] = {stream.seen_px.width_px, stream.seen_px.height_px};
  if (stream.shortest_interval_s > 0.0) json["shortest_interval_s"] = stream.shortest_interval_s;
  if (!stream.note.empty()) json["note"] = stream.note;
  if (with_checksums) {
    // In the file's own time unit.
    const bool in_us = info.time_unit_ns == 1000;
    json.update({{"sum_x", stream.sum_x},
                 {"sum_y", stream.sum_y},
                 {in_us ? "sum_t_us_mod_2_64" : "sum_t_ns_mod_2_64", stream.sum_t}});
  }
  return json;
}

}  // namespace

std::string inspectionJson(const Inspection& inspection, bool with_checksums) {
  Json json = {{"evical_inspect", 1},
               {"format", inspection.format},
               {"faults", Json::array()},
               {"streams", Json::array()}};
  for (const RecordingFault& fault : inspection.faults) {
    json["faults"].push_back(
        {{"stream", fault.stream}, {"kind", nameOf(fault.kind)}, {"at_s", fault.at_s}, {"text", fault.text}});
  }
  for (const StreamSummary& stream : inspection.streams)
    json["streams"].push_back(streamJson(stream, with_checksums));
  // Names come from the file and may contain any bytes.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace evical
