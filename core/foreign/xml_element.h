// As much of XML as robot descriptions need: elements, their attributes, comments, no text.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace evical {

struct XmlElement {
  std::string name;
  std::map<std::string, std::string> attributes;
  std::vector<XmlElement> children;
  std::string place;  // "rig.urdf: robot.joint (line 12)"

  std::vector<const XmlElement*> all(const std::string& name) const;  // children of this name
  // Both throw CalibrationError (BadInput) where there is none.
  const XmlElement& one(const std::string& name) const;
  const std::string& attribute(const std::string& name) const;
};

// The document's one root. Throws CalibrationError (BadInput) with the line of what is no XML.
XmlElement readXml(const std::filesystem::path& file);

}  // namespace evical
