// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/export_xml.h"

#include <gtest/gtest.h>

#include <string>

namespace lf {
namespace {

XmlFile ParsedXml(const std::string& text) {
  Result<XmlFile> xml = XmlFile::Parse(text, "f/a.xml");
  EXPECT_TRUE(xml) << xml.error().message << "\n" << text;
  return *std::move(xml);
}

void ExpectMessage(const Error& error, const std::string& expected) {
  EXPECT_EQ(error.kind, ErrorKind::kInput);
  EXPECT_EQ(error.message, expected);
}

TEST(ExportXml, NumbersAreSeparatedByBlanksOfAnyKind) {
  const XmlFile xml = ParsedXml("<a><b>\n 1 \t-2.5e0\r\n3 </b></a>");
  EXPECT_EQ(*xml.Root().Child("b").Numbers(3, 10), (std::vector<double>{1, -2.5, 3}));
}

TEST(ExportXml, ValuesMayBeAttributesOrChildren) {
  const XmlFile xml = ParsedXml(R"(<a p:x="1 2"><p:y>3</p:y></a>)");
  EXPECT_EQ(xml.Root().NumbersOfProperty("p:x", 2, 10)->at(1), 2);
  EXPECT_EQ(xml.Root().NumbersOfProperty("p:y", 1, 10)->at(0), 3);
  EXPECT_FALSE(xml.Root().Property("p:z"));
  EXPECT_EQ(*xml.Root().NumberOr("p:z", 7, 10), 7);
}

TEST(ExportXml, ErrorsNameTheElementTheValueAndWhatWasExpected) {
  const XmlFile xml =
      ParsedXml(R"(<d><chunk><sensor id="3" label="A"><f>x</f><g>1 nan</g></sensor></chunk></d>)");
  const XmlElement sensor = xml.Root().Child("chunk").Child("sensor");
  ExpectMessage(sensor.Child("f").Number(10).error(),
                "f/a.xml: chunk/sensor 3 (A)/f is \"x\": expected a number within +-10");
  ExpectMessage(sensor.Child("g").Numbers(2, 10).error(),
                "f/a.xml: chunk/sensor 3 (A)/g is \"1 nan\": expected 2 numbers within +-10");
  ExpectMessage(
      sensor.WholeAttribute("id", 0, 2).error(),
      "f/a.xml: chunk/sensor 3 (A) has the id \"3\": expected a whole number from 0 to 2");
  ExpectMessage(
      sensor.WholeAttribute("no", 0, 2).error(),
      "f/a.xml: chunk/sensor 3 (A) has no attribute no: expected a whole number from 0 to 2");
  ExpectMessage(sensor.NumbersOfProperty("g", 1, 10).error(),
                "f/a.xml: chunk/sensor 3 (A) has the g \"1 nan\": expected a number within +-10");
  ExpectMessage(xml.Root().Wrong("more"), "f/a.xml: the file is \"\": expected more");
}

TEST(ExportXml, TextThatIsNoXmlIsAnError) {
  for (const std::string text : {"", "x", "<a", "<a></b>", "<!-- <a/> -->", "\xff\xfe"})
    EXPECT_FALSE(XmlFile::Parse(text, "f/a.xml")) << text;
  ExpectMessage(XmlFile::Parse("<a></b>", "f/a.xml").error(),
                "f/a.xml: is not XML: Start-end tags mismatch after 5 bytes");
}

// The library expands no entities but those of XML itself, so that neither a chain of entities nor
// the content of another file gets into a value.
TEST(ExportXml, EntitiesOfADocumentAreNotExpanded) {
  const XmlFile xml = ParsedXml(
      R"(<!DOCTYPE a [<!ENTITY b "bbbb"><!ENTITY c "&b;&b;"><!ENTITY f SYSTEM "/etc/passwd">]>)"
      "<a><x>&c;</x><y>&f;</y><z>&lt;&#49;</z></a>");
  EXPECT_EQ(xml.Root().Child("x").Text(), "&c;");
  EXPECT_EQ(xml.Root().Child("y").Text(), "&f;");
  EXPECT_EQ(xml.Root().Child("z").Text(), "<1");
}

TEST(ExportXml, DeepNestingTakesNoStack) {
  std::string text;
  for (int i = 0; i < 1'000'000; ++i) text += "<a>";
  for (int i = 0; i < 1'000'000; ++i) text += "</a>";
  const XmlFile xml = ParsedXml(text);
  EXPECT_TRUE(xml.Root().Child("a").exists());
}

TEST(ExportXml, TheNumberOfTagsIsLimited) {
  const std::string text = "<a>" + std::string((size_t{1} << 24) + 1, '<');
  ExpectMessage(XmlFile::Parse(text, "f/a.xml").error(), "f/a.xml: holds more than 16777216 tags");
}

}  // namespace
}  // namespace lf
