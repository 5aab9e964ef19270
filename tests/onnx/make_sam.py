#!/usr/bin/env python3
"""A small Segment Anything (random weights) in the two usual exports, and what its makers' own code answers.

    python3 -m venv v && v/bin/pip install torch torchvision segment-anything transformers optimum-onnx onnx onnxruntime
    v/bin/python tests/onnx/make_sam.py     sam_*.onnx and sam.json in tests/fixtures/onnx

`sam_meta_encoder.onnx`, `sam_meta_decoder.onnx`: Meta's package segment_anything 1.0, the decoder by its own `SamOnnxModel`.
`sam_hf_encoder.onnx`, `sam_hf_decoder.onnx`: transformers' SamModel with the same weights' shapes, exported by optimum.
`sam.json`: for each, at some places of a picture known by formula (64 x 64, of which red is 3x + y, green 2y, blue x + 2y,
modulo 256), the best mask's score and its pixels above 0 among 16 x 16, by `SamPredictor` and by `SamModel` in torch.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import torch

TO = Path(__file__).parent.parent / "fixtures" / "onnx"
PLACES = [(12, 20), (40, 8), (33, 51)]
MEAN, STD = [123.675, 116.28, 103.53], [58.395, 57.12, 57.375]
y, x = np.mgrid[0:64, 0:64]
PICTURE = np.stack([3 * x + y, 2 * y, x + 2 * y], axis=-1).astype(np.uint8)


def louder(model):
    """Weights as they are drawn give answers that hardly depend on the question."""
    torch.manual_seed(7)
    with torch.no_grad():
        for weight in model.parameters():
            weight.add_(0.2 * torch.randn_like(weight))
    return model.eval()


def slim(path):
    """Short names for all that lies between inputs and outputs: half of such files is names."""
    import onnx

    model = onnx.load(path)
    outer = {value.name for value in [*model.graph.input, *model.graph.output]} | {""}
    short = {}
    name = lambda own: own if own in outer else short.setdefault(own, f"v{len(short)}")
    for tensor in model.graph.initializer:
        tensor.name = name(tensor.name)
    for node in model.graph.node:
        node.name, node.doc_string = "", ""
        node.ClearField("metadata_props")
        node.input[:] = [name(own) for own in node.input]
        node.output[:] = [name(own) for own in node.output]
        assert not any(attribute.g.node for attribute in node.attribute), "subgraphs have names, too"
    model.graph.ClearField("value_info")
    onnx.checker.check_model(model)
    onnx.save(model, path)


def answers(masks, scores):
    """Of each place the best of three."""
    all = []
    for (column, row), masks, scores in zip(PLACES, masks, scores):
        best = int(np.argmax(scores))
        rows = ["".join("#" if value > 0 else "." for value in row) for row in masks[best]]
        least = float(np.abs(masks[best]).min())
        all.append({"place": [column, row], "score": round(float(scores[best]), 6), "least": least, "mask": rows})
    return all


def meta():
    from segment_anything import SamPredictor
    from segment_anything.modeling import ImageEncoderViT, MaskDecoder, PromptEncoder, Sam, TwoWayTransformer
    from segment_anything.utils.onnx import SamOnnxModel

    encoder = ImageEncoderViT(
        img_size=64, patch_size=16, embed_dim=16, depth=1, num_heads=2, mlp_ratio=2, out_chans=16, use_rel_pos=True, global_attn_indexes=(0,), window_size=0
    )
    prompts = PromptEncoder(embed_dim=16, image_embedding_size=(4, 4), input_image_size=(64, 64), mask_in_chans=4)
    transformer = TwoWayTransformer(depth=1, embedding_dim=16, mlp_dim=16, num_heads=2)
    decoder = MaskDecoder(transformer_dim=16, transformer=transformer, iou_head_hidden_dim=16)
    sam = louder(Sam(encoder, prompts, decoder, MEAN, STD))
    predictor = SamPredictor(sam)
    predictor.set_image(PICTURE)
    masks, scores = [], []
    for place in PLACES:
        _, score, low = predictor.predict(point_coords=np.array([place]), point_labels=np.array([1]), multimask_output=True)
        masks.append(low)
        scores.append(score)
    picture = torch.randn(1, 3, 64, 64)
    torch.onnx.export(
        sam.image_encoder, picture, TO / "sam_meta_encoder.onnx", input_names=["x"], output_names=["image_embeddings"], opset_version=17, dynamo=False
    )
    asked = {
        "image_embeddings": torch.randn(1, 16, 4, 4),
        "point_coords": torch.randn(1, 2, 2),
        "point_labels": torch.ones(1, 2),
        "mask_input": torch.zeros(1, 1, 16, 16),
        "has_mask_input": torch.zeros(1),
        "orig_im_size": torch.tensor([64.0, 64.0]),
    }
    torch.onnx.export(
        SamOnnxModel(sam, return_single_mask=False),
        tuple(asked.values()),
        TO / "sam_meta_decoder.onnx",
        input_names=list(asked),
        output_names=["masks", "iou_predictions", "low_res_masks"],
        dynamic_axes={"point_coords": {1: "num_points"}, "point_labels": {1: "num_points"}},
        opset_version=17,
        dynamo=False,
    )
    return answers(masks, scores)


def hugging_face():
    from transformers import SamConfig, SamImageProcessor, SamModel, SamProcessor

    vision = dict(hidden_size=16, num_hidden_layers=1, num_attention_heads=2, image_size=64, output_channels=16)
    vision |= dict(global_attn_indexes=[0], window_size=0, mlp_dim=32, num_pos_feats=8)
    prompts = dict(hidden_size=16, image_size=64, patch_size=16, mask_input_channels=4)
    decoder = dict(hidden_size=16, mlp_dim=16, num_hidden_layers=1, num_attention_heads=2, iou_head_hidden_dim=16)
    sam = louder(SamModel(SamConfig(vision_config=vision, prompt_encoder_config=prompts, mask_decoder_config=decoder)))
    picture = (PICTURE.astype(np.float32) - MEAN) / STD
    picture = torch.from_numpy(picture.astype(np.float32)).permute(2, 0, 1)[None]
    points = torch.tensor(PLACES, dtype=torch.float32)[None, :, None]
    with torch.no_grad():
        given = sam(pixel_values=picture, input_points=points, multimask_output=True)
    with tempfile.TemporaryDirectory() as folder:
        sam.save_pretrained(folder)
        processor = SamImageProcessor(size={"longest_edge": 64}, pad_size={"height": 64, "width": 64}, mask_size={"longest_edge": 16})
        SamProcessor(processor).save_pretrained(folder)
        cli = Path(sys.executable).parent / "optimum-cli"
        subprocess.run([cli, "export", "onnx", "--model", folder, "--task", "feature-extraction", f"{folder}/out"], check=True)
        for own, theirs in [("encoder", "vision_encoder"), ("decoder", "prompt_encoder_mask_decoder")]:
            (TO / f"sam_hf_{own}.onnx").write_bytes((Path(folder) / "out" / f"{theirs}.onnx").read_bytes())
    return answers(given.pred_masks[0].numpy(), given.iou_scores[0].numpy())


torch.manual_seed(5)
said = {"meta": meta(), "hugging_face": hugging_face()}
for path in TO.glob("sam_*.onnx"):
    slim(path)
(TO / "sam.json").write_text(json.dumps(said, separators=(",", ":")) + "\n")
