#!/usr/bin/env python3
"""Small ONNX models for the tests of networks that the user names.

    python3 -m venv v && v/bin/pip install onnx numpy
    v/bin/python tests/onnx/make.py     the files in tests/fixtures/onnx

Each is a few hundred bytes. What they give is plain enough to be known without running them:

    dark.onnx       floats, any size: border = sigmoid(8 - 16 r), inside = 1 - border, of the red channel, as two
                    channels of one output
    squares.onnx    floats, 64 x 64 alone: two masks (rows and columns 8 to 23, and 16 to 55) with scores 0.9 and 0.7,
                    and a third one of 0.2
    numbers.onnx    bytes, channels last, any size: the gray value over 64 as the number of an instance
    yolo.onnx       floats, 64 x 64: three detections of two prototypes as YOLO's segmentation gives them
    seen.onnx       floats, 64 x 64: the means of 4 x 4 pixels, as SAM's encoder calls what it saw
    asked.onnx      a decoder in the form of Meta's: of four masks of 16 x 16 the second (score 0.95) is what has the colour
                    of the place asked at; the first (0.99, for several points) and the third (0.5) are everything, the
                    fourth (0.1) nothing; all wrong unless the labels are 1 and -1, the size 64 x 64 and there is no mask
    strange.onnx    an operator that nobody has
    two.onnx        two inputs
"""

from pathlib import Path

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

TO = Path(__file__).parent.parent / "fixtures" / "onnx"
F, U = TensorProto.FLOAT, TensorProto.UINT8


def save(name, nodes, inputs, outputs, constants=()):
    tensors = [numpy_helper.from_array(np.asarray(value), key) for key, value in constants]
    info = lambda of: helper.make_tensor_value_info(*of)
    graph = helper.make_graph(nodes, "g", [info(of) for of in inputs], [info(of) for of in outputs], tensors)
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17), helper.make_opsetid("nobody", 1)])
    model.ir_version = 8
    if name != "strange":
        onnx.checker.check_model(model)
    (TO / f"{name}.onnx").write_bytes(model.SerializeToString())


def masked(rows, columns, size):
    mask = np.zeros((size, size), np.uint8)
    mask[rows[0] : rows[1], columns[0] : columns[1]] = 1
    return mask


node = helper.make_node
TO.mkdir(exist_ok=True)

weights = np.zeros((2, 3, 1, 1), np.float32)
weights[0, 0], weights[1, 0] = -16, 16
save(
    "dark",
    [node("Conv", ["x", "w", "b"], ["c"], kernel_shape=[1, 1], strides=[1, 1], dilations=[1, 1], pads=[0, 0, 0, 0]), node("Sigmoid", ["c"], ["maps"])],
    [("x", F, [1, 3, "h", "w2"])],
    [("maps", F, [1, 2, "h", "w2"])],
    [("w", weights), ("b", np.array([8, -8], np.float32))],
)

masks = np.stack([masked((8, 24), (8, 24), 64), masked((16, 56), (16, 56), 64), masked((0, 64), (0, 64), 64)])
constant = [("m", masks), ("s", np.array([0.9, 0.7, 0.2], np.float32)), ("zero", np.array(0, np.float32))]
# The input counts for nothing, but a graph that does not use it is folded away.
save(
    "squares",
    [
        node("ReduceMax", ["x"], ["most"], keepdims=0),
        node("Mul", ["most", "zero"], ["none"]),
        node("Cast", ["m"], ["f"], to=F),
        node("Add", ["f", "none"], ["masks"]),
        node("Add", ["s", "none"], ["scores"]),
    ],
    [("x", F, [1, 3, 64, 64])],
    [("masks", F, [3, 64, 64]), ("scores", F, [3])],
    constant,
)

save(
    "numbers",
    [
        node("Cast", ["x"], ["f"], to=F),
        node("Div", ["f", "by"], ["d"]),
        node("Floor", ["d"], ["labels"]),
    ],
    [("x", U, [1, "h", "w", 1])],
    [("labels", F, [1, "h", "w", 1])],
    [("by", np.array(64, np.float32))],
)

# Middle, width and height of a box, one class, two weights; 16 x 16 prototypes.
detections = np.array(
    [[16, 16, 16, 16, 0.9, 9, -9], [17, 16, 16, 16, 0.8, 9, -9], [40, 40, 32, 32, 0.7, -9, 9]], np.float32
).T[None]
# One everywhere; and 2 in the right half.
prototypes = np.stack([np.ones((16, 16)), np.tile(np.repeat([0.0, 2.0], 8), (16, 1))]).astype(np.float32)[None]
save(
    "yolo",
    [
        node("ReduceMax", ["x"], ["most"], keepdims=0),
        node("Mul", ["most", "zero"], ["none"]),
        node("Add", ["d", "none"], ["output0"]),
        node("Add", ["p", "none"], ["output1"]),
    ],
    [("x", F, [1, 3, 64, 64])],
    [("output0", F, [1, 7, 3]), ("output1", F, [1, 2, 16, 16])],
    [("d", detections), ("p", prototypes), ("zero", np.array(0, np.float32))],
)

save(
    "seen",
    [node("AveragePool", ["x"], ["image_embeddings"], kernel_shape=[4, 4], strides=[4, 4])],
    [("x", F, [1, 3, 64, 64])],
    [("image_embeddings", F, [1, 3, 16, 16])],
)

whole = lambda *values: np.array(values, np.int64)
real = lambda *values: np.array(values, np.float32)
save(
    "asked",
    [
        # The place's pixel, of 16 x 16.
        node("Gather", ["point_coords", "first"], ["place"], axis=1),
        node("Div", ["place", "four"], ["parts"]),
        node("Floor", ["parts"], ["cell"]),
        node("Mul", ["cell", "steps"], ["walked"]),
        node("ReduceSum", ["walked", "last_axis"], ["far"], keepdims=0),
        node("Cast", ["far"], ["index"], to=TensorProto.INT64),
        node("Reshape", ["index", "one"], ["at"]),
        node("Reshape", ["image_embeddings", "flat"], ["colours"]),
        node("Gather", ["colours", "at"], ["own"], axis=1),
        node("Sub", ["colours", "own"], ["other"]),
        node("Abs", ["other"], ["others"]),
        node("ReduceSum", ["others", "first_axis"], ["differ"], keepdims=1),
        node("Less", ["differ", "least"], ["same"]),
        node("Where", ["same", "plus", "minus"], ["like"]),
        node("Reshape", ["like", "square"], ["alike"]),
        node("Mul", ["alike", "nothing"], ["zeros"]),
        node("Add", ["zeros", "plus"], ["all"]),
        node("Add", ["zeros", "minus"], ["none"]),
        # How wrong the other inputs are, 0 where they are right.
        node("Sub", ["point_labels", "labels"], ["l"]),
        node("Sub", ["orig_im_size", "size"], ["s"]),
        node("Abs", ["l"], ["la"]),
        node("Abs", ["s"], ["sa"]),
        node("ReduceMax", ["la"], ["lm"], keepdims=0),
        node("ReduceMax", ["sa"], ["sm"], keepdims=0),
        node("ReduceMax", ["mask_input"], ["mm"], keepdims=0),
        node("ReduceMax", ["has_mask_input"], ["hm"], keepdims=0),
        node("Sum", ["lm", "sm", "mm", "hm"], ["wrong"]),
        node("Mul", ["wrong", "much"], ["very"]),
        node("Concat", ["all", "alike", "all", "none"], ["four_masks"], axis=1),
        node("Sub", ["four_masks", "very"], ["low_res_masks"]),
        node("Sub", ["scores", "wrong"], ["iou_predictions"]),
    ],
    [
        ("image_embeddings", F, [1, 3, 16, 16]),
        ("point_coords", F, [1, "n", 2]),
        ("point_labels", F, [1, "n"]),
        ("mask_input", F, [1, 1, 64, 64]),
        ("has_mask_input", F, [1]),
        ("orig_im_size", F, [2]),
    ],
    [("low_res_masks", F, [1, 4, 16, 16]), ("iou_predictions", F, [1, 4])],
    [
        ("first", whole(0)),
        ("one", whole(1)),
        ("flat", whole(3, 256)),
        ("square", whole(1, 1, 16, 16)),
        ("first_axis", whole(0)),
        ("last_axis", whole(-1)),
        ("four", real(4)),
        ("steps", real(1, 16)),
        ("least", real(0.02)),
        ("plus", real(1)),
        ("minus", real(-1)),
        ("nothing", real(0)),
        ("much", real(100)),
        ("labels", real(1, -1)),
        ("size", real(64, 64)),
        ("scores", np.array([[0.99, 0.95, 0.5, 0.1]], np.float32)),
    ],
)

save(
    "strange",
    [node("Frobnicate", ["x"], ["y"], domain="nobody")],
    [("x", F, [1, 3, "h", "w"])],
    [("y", F, [1, 1, "h", "w"])],
)
save(
    "two",
    [node("Add", ["x", "y"], ["z"])],
    [("x", F, [1, 3, "h", "w"]), ("y", F, [1, 3, "h", "w"])],
    [("z", F, [1, 3, "h", "w"])],
)
