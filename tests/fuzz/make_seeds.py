#!/usr/bin/env python3
"""Writes the seeds of corpus/ that no editor can: binary logs, compressed files, rows of 707 tokens.

    tests/fuzz/make_seeds.py

Every file is put together byte by byte from the formats' descriptions, so that it is small, always
the same and independent of the readers and writers it is for. The other seeds are text, kept by hand.
"""
import bz2
import math
import struct
import zlib
from pathlib import Path

CORPUS = Path(__file__).resolve().parent / "corpus"
SEPARATOR = b"\n%%\n"
ROBOT = b"""[robot]
name = "seed"
[wheels]
track_m = 0.35
left_m_per_tick = 1e-4
right_m_per_tick = 1e-4
[lidar]
x_m = 0.1
range_max_m = 4.5
"""


def write(path, data):
    file = CORPUS / path
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_bytes(data)


def gzip_member(content):
    deflate = zlib.compressobj(9, zlib.DEFLATED, 31)
    return deflate.compress(content) + deflate.flush()


# ---------------------------------------------------------------- MRPT rawlog

UNIX_EPOCH_TICKS = 116_444_736_000_000_000


def rawlog_object(name, version, body):
    return bytes([0x80 | len(name)]) + name + bytes([version]) + body + b"\x88"


def rawlog_text(text):
    return struct.pack("<I", len(text)) + text


def rawlog_stamp(seconds):
    return struct.pack("<Q", UNIX_EPOCH_TICKS + round(seconds * 1e7))


def pose2(x, y, phi):
    return rawlog_object(b"mrpt::poses::CPose2D", 1, struct.pack("<3d", x, y, phi))


def pose3(x, y):
    return rawlog_object(b"mrpt::poses::CPose3D", 2, struct.pack("<7d", x, y, 0, 1, 0, 0, 0))


def comment(text):
    return rawlog_object(b"mrpt::obs::CObservationComment", 0, rawlog_text(text) + rawlog_stamp(0))


def rawlog_scan(seconds, ranges):
    n = len(ranges)
    body = struct.pack("<fBf", 1.5, 1, 4.5) + pose3(0.1, 0)
    body += struct.pack(f"<I{n}f", n, *ranges) + bytes(r < 4.5 for r in ranges)
    body += struct.pack("<f", 0.01) + rawlog_stamp(seconds) + struct.pack("<f", 0)
    body += rawlog_text(b"LIDAR") + struct.pack("<d", 0) + b"\0"
    return rawlog_object(b"mrpt::obs::CObservation2DRangeScan", 7, body)


def rawlog_wheels(seconds, x, left, right):
    body = pose2(x, 0, 0) + rawlog_text(b"WHEELS") + rawlog_stamp(seconds)
    body += b"\1" + struct.pack("<2i", left, right) + b"\0"
    return rawlog_object(b"mrpt::obs::CObservationOdometry", 2, body)


def rawlog_imu(seconds):
    body = pose3(0, 0) + bytes([1] * 31) + rawlog_stamp(seconds)
    body += struct.pack("<31d", *[0.01 * i for i in range(31)]) + rawlog_text(b"IMU")
    return rawlog_object(b"mrpt::obs::CObservationIMU", 4, body)


def actions(seconds, dx):
    body = struct.pack("<I", 0) + pose2(dx, 0, 0.01)
    body += struct.pack("<I6f", 0, 0.01, 0.001, 0.01, 0.001, 0.05, 0.05)
    body += struct.pack("<I6f", 300, 0.05, 0.05, 0.05, 0.05, 0.1, 0.01)
    body += b"\0" + b"\0" + rawlog_stamp(seconds)
    movement = rawlog_object(b"mrpt::obs::CActionRobotMovement2D", 7, body)
    return rawlog_object(b"mrpt::obs::CActionCollection", 0, struct.pack("<I", 1) + movement)


def sensory_frame(observations):
    body = struct.pack("<I", len(observations)) + b"".join(observations)
    return rawlog_object(b"mrpt::obs::CSensoryFrame", 2, body)


def rawlogs():
    observations = comment(ROBOT)
    for step in range(2):
        seconds = 1 + 0.1 * step
        observations += rawlog_wheels(seconds - 0.02, 0.05 * step, 500 * step, 510 * step)
        observations += rawlog_imu(seconds - 0.01)
        observations += rawlog_scan(seconds, [1.0, 1.5, 5.5, 2.0])
    frames = b""
    for step in range(3):
        frames += actions(1 + 0.1 * step, 0.05) + sensory_frame(
            [rawlog_scan(1.05 + 0.1 * step, [1.0, 1.5, 5.5])])
    for target in ("rawlog", "rawlog_framing"):
        write(f"{target}/observations.rawlog", observations)
        write(f"{target}/frames.rawlog", frames)
        write(f"{target}/scan.rawlog", rawlog_scan(1, [1.0, 5.5]))


# ---------------------------------------------------------------- ROS 1 bag

TYPES = {
    "scan": (b"sensor_msgs/LaserScan", b"90c7ef2dc6895d81024acba2ac42f369"),
    "odom": (b"nav_msgs/Odometry", b"cd5e73d190d741a2f92e81eda573aca7"),
    "imu": (b"sensor_msgs/Imu", b"6a62c6daae103f4ff57a132d6f95cec2"),
    "joints": (b"sensor_msgs/JointState", b"3066dcd76a6cfaef579bd0f34173e9fd"),
    "clockwise": (b"sensor_msgs/LaserScan", b"90c7ef2dc6895d81024acba2ac42f369"),
}
CONNECTIONS = list(TYPES)


def fields(pairs):
    return b"".join(struct.pack("<I", len(n) + 1 + len(v)) + n + b"=" + v for n, v in pairs)


def bag_record(pairs, data):
    header = fields(pairs)
    return struct.pack("<I", len(header)) + header + struct.pack("<I", len(data)) + data


def u32(value):
    return struct.pack("<I", value)


def bag_time(ns):
    return struct.pack("<II", ns // 10**9, ns % 10**9)


def ros_text(text):
    return u32(len(text)) + text


def ros_message(kind, ns, step):
    header = u32(step) + bag_time(ns) + ros_text(b"f")
    if kind == "scan":
        ranges = [1.0, 1.5, 5.5, 2.0]
        return (header + struct.pack("<7f", -0.375, 0.375, 0.25, 0, 0.1, 0.125, 4.5)
                + u32(4) + struct.pack("<4f", *ranges) + u32(0))
    if kind == "clockwise":  # from the left to the right, a beam each 1/64 s
        return (header + struct.pack("<7f", 0.375, -0.375, -0.25, 1 / 64, 0.1, 0.125, 4.5)
                + u32(4) + struct.pack("<4f", 2.0, 5.5, 1.5, 1.0) + u32(0))
    if kind == "odom":
        pose = struct.pack("<7d", 0.05 * step, 0, 0, 0, 0, 0, 1) + bytes(8 * 36)
        return header + ros_text(b"b") + pose + bytes(8 * 6) + bytes(8 * 36)
    if kind == "imu":
        return (header + struct.pack("<4d", 0, 0, 0, 1) + bytes(72)
                + struct.pack("<3d", 0, 0, 0.01) + bytes(72)
                + struct.pack("<3d", 0.25, -0.5, 9.8) + bytes(72))
    return (header + u32(2) + ros_text(b"left") + ros_text(b"right")
            + u32(2) + struct.pack("<2d", 0.1 * step, 0.1 * step) + u32(0) + u32(0))


def bag_connection(kind):
    name, md5 = TYPES[kind]
    topic = b"/" + kind.encode()
    data = fields([(b"topic", topic), (b"type", name), (b"md5sum", md5),
                   (b"message_definition", b"")])
    return bag_record([(b"op", b"\x07"), (b"conn", u32(CONNECTIONS.index(kind))),
                       (b"topic", topic)], data)


def xxh32(data):
    """The checksum of LZ4 frames."""
    prime1, prime2, prime3, prime4, prime5 = (
        2654435761, 2246822519, 3266489917, 668265263, 374761393)
    mask = 0xFFFFFFFF

    def rotate(value, bits):
        return ((value << bits) | (value >> (32 - bits))) & mask

    at = 0
    h = prime5
    if len(data) >= 16:
        lanes = [(prime1 + prime2) & mask, prime2, 0, -prime1 & mask]
        while at + 16 <= len(data):
            words = struct.unpack_from("<4I", data, at)
            lanes = [rotate((lane + word * prime2) & mask, 13) * prime1 & mask
                     for lane, word in zip(lanes, words)]
            at += 16
        h = sum(rotate(lane, bits) for lane, bits in zip(lanes, (1, 7, 12, 18)))
    h = (h + len(data)) & mask
    while at + 4 <= len(data):
        h = rotate((h + struct.unpack_from("<I", data, at)[0] * prime3) & mask, 17) * prime4 & mask
        at += 4
    for byte in data[at:]:
        h = rotate((h + byte * prime5) & mask, 11) * prime1 & mask
    h = (h ^ (h >> 15)) * prime2 & mask
    h = (h ^ (h >> 13)) * prime3 & mask
    return h ^ (h >> 16)


def lz4_frame(content):
    """One block as it stands. rosbag asks for independent blocks and the content's checksum."""
    descriptor = b"\x64\x40"  # version 1, independent blocks of at most 64 KiB, content's checksum
    frame = struct.pack("<I", 0x184D2204) + descriptor + bytes([(xxh32(descriptor) >> 8) & 0xFF])
    return (frame + struct.pack("<I", 0x80000000 | len(content)) + content + u32(0)
            + u32(xxh32(content)))


COMPRESS = {b"none": lambda content: content, b"bz2": bz2.compress, b"lz4": lz4_frame}


def bag(messages, compression):
    """`messages`: (kind, nanoseconds, step), in order."""
    kinds = [kind for kind in CONNECTIONS if any(m[0] == kind for m in messages)]
    content = b"".join(bag_connection(kind) for kind in kinds)
    entries = {kind: b"" for kind in kinds}
    for kind, ns, step in messages:
        entries[kind] += bag_time(ns) + u32(len(content))
        content += bag_record([(b"op", b"\x02"), (b"conn", u32(CONNECTIONS.index(kind))),
                               (b"time", bag_time(ns))], ros_message(kind, ns - 10**6, step))
    chunk = bag_record([(b"op", b"\x05"), (b"compression", compression),
                        (b"size", u32(len(content)))], COMPRESS[compression](content))
    for kind in kinds:
        chunk += bag_record([(b"op", b"\x04"), (b"ver", u32(1)),
                             (b"conn", u32(CONNECTIONS.index(kind))),
                             (b"count", u32(len(entries[kind]) // 12))], entries[kind])

    def file_header(index_pos):
        return b"#ROSBAG V2.0\n" + bag_record(
            [(b"op", b"\x03"), (b"index_pos", struct.pack("<Q", index_pos)),
             (b"conn_count", u32(len(kinds))), (b"chunk_count", u32(1))], b"")

    chunk_pos = len(file_header(0))
    counts = b"".join(u32(CONNECTIONS.index(kind)) + u32(len(entries[kind]) // 12)
                      for kind in kinds)
    info = bag_record([(b"op", b"\x06"), (b"ver", u32(1)),
                       (b"chunk_pos", struct.pack("<Q", chunk_pos)),
                       (b"start_time", bag_time(messages[0][1])),
                       (b"end_time", bag_time(messages[-1][1])),
                       (b"count", u32(len(kinds)))], counts)
    listing = b"".join(bag_connection(kind) for kind in kinds)
    return file_header(chunk_pos + len(chunk)) + chunk + listing + info


def bags():
    second = 10**9
    drive = []
    for step in range(2):
        ns = 100 * second + step * second // 10
        drive += [("odom", ns, step), ("imu", ns + 10**6, step), ("scan", ns + 2 * 10**6, step)]
    scans = [("scan", 100 * second + i * second // 10, i) for i in range(2)]
    joints = [m for i in range(2) for m in (("joints", 100 * second + i * second // 10, i),
                                            ("scan", 100 * second + i * second // 10 + 1, i))]
    clockwise = [("clockwise", 100 * second + i * second // 10, i) for i in range(2)]
    topics = (b'[topics]\njoints = "/joints"\n'
              b'[joints]\nleft = "left"\nright = "right"\nticks_per_turn = 4096\n')
    write("bag/drive.bag", SEPARATOR + bag(drive, b"none"))
    write("bag/joints.bag", topics + SEPARATOR + bag(joints, b"none"))
    for compression in COMPRESS:
        name = compression.decode()
        write(f"bag/scans-{name}.bag", SEPARATOR + bag(scans, compression))
        write(f"bag_framing/scans-{name}.bag", bag(scans, compression))
    write("bag_framing/drive.bag", bag(drive, b"none"))
    write("bag_framing/joints.bag", bag(joints, b"none"))
    write("bag_framing/clockwise.bag", bag(clockwise, b"none"))
    write("bag/clockwise.bag", SEPARATOR + bag(clockwise, b"none"))
    text = b"a chunk of a bag, a chunk of a bag"
    for compression in COMPRESS:
        head = compression[:1] + struct.pack(">H", len(text))
        write(f"bag_chunk/{compression.decode()}.bin", head + COMPRESS[compression](text))


# ---------------------------------------------------------------- LCM event log

def lcm_event(number, utime_us, channel, data):
    return struct.pack(">IQqII", 0xEDA1DA01, number, utime_us, len(channel), len(data)) + channel + data


def lcm_logs():
    for clock, ahead_us in (("data", 0), ("event-offset", 5_000_000)):
        events = []
        for step in range(3):
            now_us = 100_000_000 + 100_000 * step
            board_us = now_us + ahead_us
            events.append((now_us + 500, b"MAEBOT_MOTOR_FEEDBACK", struct.pack(
                ">Qqii", 0x8DC5A028FCA42FF9, board_us, 100 * step, 101 * step) + bytes(24)))
            events.append((now_us + 600, b"MAEBOT_SENSOR_DATA", struct.pack(
                ">Qq6h", 0xC320824C265E849A, board_us, 10, 20, 16384, 1, 2, 131) + bytes(42)))
            n = 40  # of a whole turn
            scan = struct.pack(">Qqi", 0x89DC5B879A5056CF, now_us, n)
            scan += struct.pack(f">{n}f", *[1 + 0.05 * i for i in range(n)])
            scan += struct.pack(f">{n}f", *[2 * math.pi * i / n for i in range(n)])
            scan += struct.pack(f">{n}q", *[now_us + 1000 * i for i in range(n)])
            scan += struct.pack(f">{n}f", *[0.5] * n)
            events.append((now_us + 6000, b"RPLIDAR_LASER_SCAN", scan))
            events.append((now_us + 7000, b"MAEBOT_POSE", struct.pack(
                ">Qq3f", 0x1F317AF1246276AC, now_us + 5000, 0.1 * step, 0, 0)))
        log = b"".join(lcm_event(i, *event) for i, event in enumerate(events))
        toml = ROBOT + b'[raw]\nclock = "%s"\n' % clock.encode()
        write(f"lcm/{clock}.lcm", toml + SEPARATOR + log)


# ---------------------------------------------------------------- text too long to write, gzip

def ticks_logs():
    rows = b""
    for step in range(2):
        tokens = [1_000_000 + 100_000 * step, 0, 100 * step, 101 * step] + [0] * 20
        tokens += [1000 if i % 100 == 0 else 0 for i in range(682)] + [0]
        rows += b" ".join(b"%d" % token for token in tokens) + b"\n"
    write("ticks/two-rows.dat", ROBOT + SEPARATOR + rows)
    write("ticks/offset.dat", ROBOT + b"time_offset_s = 0.02\n" + SEPARATOR + rows)


def gzips():
    text = b"what a file says, what a file says\n"
    write("gzip/one-member.gz", gzip_member(text))
    write("gzip/two-members.gz", gzip_member(text) + gzip_member(b""))
    write("gzip/plain.txt", text)
    write("gzip/bomb-below-the-limit.gz", gzip_member(bytes(1 << 16)))


rawlogs()
bags()
lcm_logs()
ticks_logs()
gzips()
