# cmake -DOUTPUT=x.cpp -DFUNCTION=ns::name -DBASE=dir -DFILES=a,b -P EmbedShaders.cmake
# Writes a C++ file whose function returns the files' names (relative to BASE) and texts.
string(REPLACE "," ";" files "${FILES}")
set(entries "")
foreach(file IN LISTS files)
  file(RELATIVE_PATH name ${BASE} ${file})
  file(READ ${file} text)
  string(APPEND entries "    {\"${name}\", R\"GLSL(${text})GLSL\"},\n")
endforeach()
file(WRITE ${OUTPUT}
"#include \"gl/embedded_shaders.h\"

namespace {
// One unused entry in front, so that a method without shaders has an array too.
constexpr lodbench::gl::ShaderSource kSources[] = {
    {\"\", \"\"},
${entries}};
}  // namespace

std::span<const lodbench::gl::ShaderSource> ${FUNCTION}() {
    return std::span(kSources).subspan(1);
}
")
