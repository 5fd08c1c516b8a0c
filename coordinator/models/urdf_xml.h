// A file that should be URDF, as a tree of XML elements that know their lines.
#pragma once

#include <tinyxml2.h>

#include <memory>
#include <string>
#include <string_view>

namespace tcs {

// A document whose root is <robot>. Throws ModelMistake for anything else: a file that is no XML,
// nests too deep, defines entities, is an unexpanded xacro, or another format. Takes time and
// memory in proportion to the file, which is of 4 MiB at most.
std::unique_ptr<tinyxml2::XMLDocument> ReadUrdfXml(const std::string& path);
// The same, for a text. `name` is the text's name in sentences.
std::unique_ptr<tinyxml2::XMLDocument> ParseUrdf(const std::string& name, const std::string& text);

// Whether the file `path` can be read and is one that xacro is to expand.
bool IsXacroFile(const std::string& path);

// Throws ModelMistake, "PATH:LINE: SENTENCE".
[[noreturn]] void FailAt(const std::string& path, int line, std::string_view sentence);

// A text that a file holds as a sentence shows it, in quotes: cut to a length that can be read,
// without characters that a terminal would act on.
std::string Quoted(std::string_view text);

}  // namespace tcs
