"""Walks an MCAP file without compression by the specification (mcap.dev/spec) and checks every index and checksum.

Prints the number of messages and chunks.
"""
import struct
import sys
import zlib

MAGIC = b"\x89MCAP0\r\n"
FOOTER, MESSAGE, CHUNK, MESSAGE_INDEX, CHUNK_INDEX, STATISTICS = 2, 5, 6, 7, 8, 11
SUMMARY_OFFSET, DATA_END = 14, 15

data = open(sys.argv[1], "rb").read()
assert data.startswith(MAGIC) and data.endswith(MAGIC)


def records(position, last):
    while True:
        op, size = struct.unpack_from("<BQ", data, position)
        yield position, op, position + 9, size
        if op == last:
            return
        position += 9 + size


def check_message(chunk, offset, channel, time):
    first, end, content, _ = chunk
    assert content[offset] == MESSAGE
    assert struct.unpack_from("<H", content, offset + 9)[0] == channel
    assert struct.unpack_from("<Q", content, offset + 15)[0] == time
    assert first <= time <= end


chunks, indexes, indexed = {}, {}, 0
for position, op, at, size in records(len(MAGIC), DATA_END):
    if op == CHUNK:
        first, end, plain, crc, name = struct.unpack_from("<QQQII", data, at)
        assert name == 0
        content = data[at + 40:at + size]
        assert struct.unpack_from("<Q", data, at + 32)[0] == plain == len(content)
        assert zlib.crc32(content) == crc
        chunks[position] = (first, end, content, 9 + size)
        current = position
    if op == MESSAGE_INDEX:
        channel, length = struct.unpack_from("<HI", data, at)
        for i in range(0, length, 16):
            time, offset = struct.unpack_from("<QQ", data, at + 6 + i)
            check_message(chunks[current], offset, channel, time)
            indexed += 1
        indexes[(current, channel)] = position
    summary = at + size

found = 0
for position, op, at, size in records(summary, FOOTER):
    if op == CHUNK_INDEX:
        first, end, start, length, offsets = struct.unpack_from("<QQQQI", data, at)
        assert chunks[start][:2] == (first, end) and chunks[start][3] == length
        for i in range(0, offsets, 10):
            channel, index = struct.unpack_from("<HQ", data, at + 36 + i)
            assert indexes.pop((start, channel)) == index
        found += 1
    if op == STATISTICS:
        messages = struct.unpack_from("<Q", data, at)[0]
        assert struct.unpack_from("<I", data, at + 22)[0] == len(chunks)
    if op == SUMMARY_OFFSET:
        group, start, length = struct.unpack_from("<BQQ", data, at)
        assert data[start] == group and data[start + length] != group
assert not indexes and found == len(chunks) and messages == indexed
start, offsets, crc = struct.unpack_from("<QQI", data, at)
assert start == summary and data[offsets] == SUMMARY_OFFSET
assert zlib.crc32(data[summary:at + 16]) == crc
assert at + size + len(MAGIC) == len(data)
print(messages, len(chunks))
