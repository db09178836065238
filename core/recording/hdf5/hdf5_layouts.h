// Finds events, IMU samples, frames and triggers among the datasets of a file, in the layouts that data sets
// use: DSEC, VECtor, TUM-VIE (events/{x,y,t,p}, t_offset), e2calib (the same at the root), M3ED
// (prophesee/left/{x,y,t,p}, ovc/imu/{ts,omega,accel}, ovc/left/data with ovc/ts), MVSEC
// (davis/left/events, imu, imu_ts, image_raw, image_raw_ts), evlib
// (raw_events/{x,y,t,p}), Metavision (CD/events, EXT_TRIGGER/events).
#pragma once

#include "core/recording/hdf5/hdf5_frames.h"
#include "core/recording/hdf5/hdf5_tables.h"
#include "core/recording/recording_reader.h"

#include <memory>
#include <string>
#include <vector>

namespace evical::hdf5 {

struct FoundStream {
  StreamInfo info;
  std::unique_ptr<EventTable> events;  // one of the three, or none: listed only
  std::unique_ptr<ImuTable> imu;
  std::unique_ptr<FrameTable> frames;
};

struct FoundStreams {
  std::vector<FoundStream> streams;
  std::vector<std::string> problems;  // sentences on omitted datasets
};

// `names`: datasets of a stream in other layouts, "t_us=a/time,x=a/col,y=a/row,p=a/sign" or
// "t_ns=b/t,gyro=b/w,accel=b/a". Throws CalibrationError (BadInput) if there is neither an event nor an IMU
// sample nor a picture, or a named dataset is missing.
FoundStreams findStreams(hid_t file, const std::string& place, const ColumnNames& names);

}  // namespace evical::hdf5
