// SPDX-License-Identifier: Apache-2.0
// Reads values of XML files that other programs exported. Errors name the file, the element, the
// value found and what was expected:
//
//   a/cameras.xml: chunk/sensors/sensor 0/calibration/f is "x": expected a number from 0 to 1e+07
//
// A file cannot make the program read other files, and takes at most a few hundred bytes of memory
// for each of its tags: the library, pugixml, expands no entities but the five of XML itself, and
// visits nested elements without recursion.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/result.h"

namespace lf {

// Largest size of an XML file, for ReadFile(): 400,000 cameras of Metashape with covariances.
inline constexpr size_t kMostXmlBytes = size_t{512} << 20;

// An element in a file, or nothing. The XmlFile must outlive it.
class XmlElement {
 public:
  bool exists() const { return !node_.empty(); }
  std::string_view name() const { return node_.name(); }

  // Return elements inside this one, by their name: the first, or all in their order. The result is
  // nothing, or empty, if there is none.
  XmlElement Child(const char* name) const { return {node_.child(name), file_}; }
  std::vector<XmlElement> Children(const char* name) const;

  // Returns the text of an attribute; nullopt if it is missing.
  std::optional<std::string_view> Attribute(const char* name) const;
  // Returns the text in this element without the blanks around it.
  std::string_view Text() const;
  // Returns what an attribute of this name says or, if there is none, the text in the child of this
  // name. nullopt if both are missing. XMP may write a value in either way.
  std::optional<std::string_view> Property(const char* name) const;

  // Return the text of this element as numbers separated by blanks, within +-most. kInput if it is
  // none, or not `count` of them.
  Result<double> Number(double most) const;
  Result<std::vector<double>> Numbers(size_t count, double most) const;
  // Returns the number in a child; `otherwise` if there is no such child.
  Result<double> NumberOr(const char* name, double otherwise, double most) const;
  // Returns a property as `count` numbers.
  Result<std::vector<double>> NumbersOfProperty(const char* name, size_t count, double most) const;
  // Returns an attribute that must be a whole number from `least` to `most`.
  Result<int> WholeAttribute(const char* name, int least, int most) const;

  // Returns the error "FILE: PLACE is TEXT: expected EXPECTED".
  Error Wrong(std::string_view expected) const;
  // Returns the error "FILE: PLACE MESSAGE". The place is the path of the element, in which
  // elements are told apart by their attributes id and label.
  Error Fault(std::string_view message) const;

 private:
  friend class XmlFile;
  XmlElement(pugi::xml_node node, const std::filesystem::path* file) : node_(node), file_(file) {}

  pugi::xml_node node_;
  const std::filesystem::path* file_;
};

// A parsed file.
class XmlFile {
 public:
  // Parses the text of a file. kInput if it is not XML, or has more than 2^24 tags. kOutput if the
  // memory does not suffice.
  //   file  for messages
  static Result<XmlFile> Parse(std::string_view text, const std::filesystem::path& file);

  // Returns the outermost element.
  XmlElement Root() const { return {document_->document_element(), file_.get()}; }

 private:
  XmlFile() = default;

  // The elements refer to the text and the path, which therefore keep their places.
  std::unique_ptr<std::string> text_;
  std::unique_ptr<std::filesystem::path> file_;
  std::unique_ptr<pugi::xml_document> document_;
};

// Returns the numbers in a text, which blanks separate; nullopt if they are not `count`, or one is
// not a finite number within +-most.
std::optional<std::vector<double>> NumbersIn(std::string_view text, size_t count, double most);

}  // namespace lf
