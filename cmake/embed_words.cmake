# cmake -DFROM=FILE -DTO=HEADER -DNAME=NAME -P embed_words.cmake: a file of little-endian 32-bit words as the array
# `const uint32_t NAME[]`.
file(READ ${FROM} bytes HEX)
string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1,\n" words "${bytes}")
file(WRITE ${TO} "#pragma once\nconst uint32_t ${NAME}[] = {\n${words}};\n")
