"""Assets from strangers: what is too large, damaged or a trap is an error before memory is taken; no code runs."""

import io
import pickle
import struct
import zipfile
import zlib
from contextlib import suppress

import numpy as np
import OpenImageIO as oiio
import pytest
from pxr import Gf, Usd, UsdGeom, UsdUtils, Vt

import scratchwarp as sw
from scratchwarp.image import read_layers, read_texture
from scratchwarp.profiles.cache import read_table
from scratchwarp.scene import Budget, TooLarge
from scratchwarp.scene.memory import parsed, spelled
from scratchwarp.stage.crate import claims

TEXTURED = """#usda 1.0
(
    metersPerUnit = 1
    upAxis = "Y"
)
def Mesh "Ball" (
    prepend apiSchemas = ["MaterialBindingAPI"]
)
{
    int[] faceVertexCounts = [3]
    int[] faceVertexIndices = [0, 1, 2]
    point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
    uniform token subdivisionScheme = "none"
    rel material:binding = </Mat>
}
def Material "Mat"
{
    token outputs:surface.connect = </Mat/Surface.outputs:surface>
    def Shader "Surface"
    {
        uniform token info:id = "UsdPreviewSurface"
        color3f inputs:diffuseColor.connect = </Mat/Image.outputs:rgb>
        token outputs:surface
    }
    def Shader "Image"
    {
        uniform token info:id = "UsdUVTexture"
        asset inputs:file = @./FILE@
        float3 outputs:rgb
    }
}
"""


def stage(folder, file):
    path = folder / "stage.usda"
    path.write_text(TEXTURED.replace("FILE", file))
    return path


def png(path, width, height, level=9):
    """A PNG of a declared size with next to nothing in it."""

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    data = zlib.compress(b"\0" * 4096, level)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", data) + chunk(b"IEND", b""))


def exr(path, width, height):
    """An EXR whose header declares another size than the file holds."""
    spec = oiio.ImageSpec(16, 16, 3, oiio.HALF)
    spec.attribute("compression", "zip")
    out = oiio.ImageOutput.create(str(path))
    out.open(str(path), spec)
    out.write_image(np.zeros((16, 16, 3), np.float32))
    out.close()
    data = bytearray(path.read_bytes())
    for name in (b"dataWindow\0box2i\0", b"displayWindow\0box2i\0"):
        at = data.index(name) + len(name) + 4
        data[at : at + 16] = struct.pack("<4i", 0, 0, width - 1, height - 1)
    path.write_bytes(data)


@pytest.mark.parametrize("make", [png, exr])
@pytest.mark.parametrize("edge", [60_000, 16_000])
def test_a_picture_that_claims_a_size_is_no_picture(tmp_path, make, edge):
    file = tmp_path / f"bomb.{make.__name__}"
    make(file, edge, edge)
    assert file.stat().st_size < 20_000
    with pytest.raises((TooLarge, OSError), match=r"bomb\.(png|exr): (claims|cannot be)") as raised:
        read_texture(file)
    if make is exr:
        with pytest.raises((TooLarge, OSError), match="bomb.exr: "):
            read_layers(file)
    if isinstance(raised.value, TooLarge):  # else OpenImageIO has refused it before
        with pytest.raises(TooLarge, match=f"/Mat/Image.*bomb.{make.__name__}"):
            sw.read(stage(tmp_path, file.name))


def test_a_texture_larger_than_it_may_be_names_prim_and_file(tmp_path):
    """256 x 256 pixels of 4 floats are 1.05 MB, and as much again while 3 channels are decoded."""
    out = oiio.ImageOutput.create(str(tmp_path / "grey.png"))
    out.open(str(tmp_path / "grey.png"), oiio.ImageSpec(256, 256, 3, oiio.UINT8))
    out.write_image(np.full((256, 256, 3), 128, np.uint8))
    out.close()
    path = stage(tmp_path, "grey.png")
    assert len(sw.read(path, max_memory=3e6).textures) == 1
    with pytest.raises(TooLarge, match=r"/Mat/Image: .*grey.png: 256 x 256 pixels of 3 channels would take 1.84 MB; "):
        sw.read(path, max_memory=1e6)


def test_meshes_curves_and_instances_are_bounded(tmp_path):
    made = Usd.Stage.CreateNew(str(tmp_path / "large.usda"))
    mesh = UsdGeom.Mesh.Define(made, "/World/Sheet")
    n = 60
    mesh.CreatePointsAttr([Gf.Vec3f(x, y, 0) for y in range(n + 1) for x in range(n + 1)])
    a = [y * (n + 1) + x for y in range(n) for x in range(n)]
    mesh.CreateFaceVertexCountsAttr([4] * len(a))
    mesh.CreateFaceVertexIndicesAttr([i + d for i in a for d in (0, 1, n + 2, n + 1)])
    many = UsdGeom.PointInstancer.Define(made, "/World/Many")
    many.CreatePrototypesRel().SetTargets(["/World/Sheet"])
    many.CreateProtoIndicesAttr([0] * 2000)
    many.CreatePositionsAttr([Gf.Vec3f(0, 0, i) for i in range(2000)])
    made.Save()
    assert sw.read(tmp_path / "large.usda").triangles >= 2 * n * n
    with pytest.raises(TooLarge, match=r"large.usda: /World/Sheet: a mesh of 3721 points and 14400 corners would take"):
        sw.read(tmp_path / "large.usda", max_memory=5e6, mask="/World/Sheet")
    with pytest.raises(TooLarge, match=r"large.usda: /World/Many: 2000 instances would take 4 MB"):
        sw.read(tmp_path / "large.usda", max_memory=3e6)


def crate(path):
    """30 million zeros in 40 KB, and small arrays, one of them with time samples."""
    made = Usd.Stage.CreateNew(str(path))
    UsdGeom.SetStageMetersPerUnit(made, 1.0)
    made.SetDefaultPrim(made.DefinePrim("/World", "Xform"))
    mesh = UsdGeom.Mesh.Define(made, "/World/Sheet")
    mesh.CreatePointsAttr(Vt.Vec3fArray(1000))
    mesh.CreateFaceVertexIndicesAttr(Vt.IntArray(30_000_000))
    mesh.CreateFaceVertexCountsAttr().Set(Vt.IntArray(100), 1.0)
    mesh.GetFaceVertexCountsAttr().Set(Vt.IntArray(101), 2.0)
    for i in range(50):
        UsdGeom.Xform.Define(made, f"/World/x{i}").AddTranslateOp().Set((0.1 * i, 0.0, 0.0))
    made.Save()


def test_arrays_of_a_crate_are_bounded_before_they_are_unpacked(tmp_path):
    crate(tmp_path / "bomb.usdc")
    data = (tmp_path / "bomb.usdc").read_bytes()
    assert len(data) < 60_000
    counts = sorted((count, kind) for _, count, kind in claims(data))
    assert counts[-4:] == [(100, "int"), (101, "int"), (1000, "GfVec3f"), (30_000_000, "int")]
    made = f"{tmp_path}/bomb.usdz"
    assert UsdUtils.CreateNewUsdzPackage(str(tmp_path / "bomb.usdc"), made)
    (tmp_path / "over.usda").write_text("#usda 1.0\n(\n subLayers = [@./bomb.usdz@]\n)\n")
    for name, said in (("bomb.usdc", "/World/Sheet.faceVertexIndices"), ("bomb.usdz", ""), ("over.usda", "bomb.usdz")):
        with pytest.raises(TooLarge, match=rf"{said}.*an array of 30000000 elements would take 120 MB; 50 MB"):
            sw.read(tmp_path / name, max_memory=5e7)
    for cut in range(0, 3000, 97):  # what is damaged is left to USD, whatever it claims
        with suppress(ValueError, struct.error, IndexError, KeyError):
            list(claims(data[: len(data) - cut]))


def test_damaged_binary_files_end_in_one_message(tmp_path):
    """Cut short and overwritten at 60 places: read, or refused by one line that names the file. Found that USD's own
    checks stand 2000 such files; ours must not fall over what they let pass."""
    rng = np.random.default_rng(5)
    good = Usd.Stage.CreateNew(str(tmp_path / "good.usdc"))
    UsdGeom.SetStageMetersPerUnit(good, 1.0)
    mesh = UsdGeom.Mesh.Define(good, "/World/Sheet")
    mesh.CreatePointsAttr([Gf.Vec3f(x, y, 0) for y in range(9) for x in range(9)])
    a = [9 * y + x for y in range(8) for x in range(8)]
    mesh.CreateFaceVertexCountsAttr([4] * len(a))
    mesh.CreateFaceVertexIndicesAttr([i + d for i in a for d in (0, 1, 10, 9)])
    good.Save()
    grey = np.full((9, 9, 3), 0.5, np.float32)
    for suffix in ("exr", "png", "hdr"):
        out = oiio.ImageOutput.create(str(tmp_path / f"good.{suffix}"))
        out.open(str(tmp_path / f"good.{suffix}"), oiio.ImageSpec(9, 9, 3, oiio.FLOAT))
        out.write_image(grey)
        out.close()
    refused = 0
    for suffix in ("usdc", "exr", "png", "hdr"):
        data = (tmp_path / f"good.{suffix}").read_bytes()
        for number in range(15):
            bad = bytearray(data[: rng.integers(len(data))] if number % 5 == 0 else data)
            for at in rng.integers(0, max(len(bad) - 4, 1), 3):
                bad[at : at + 4] = rng.bytes(4) if number % 2 else b"\xff\xff\xff\x7f"
            file = tmp_path / f"bad{number}.{suffix}"
            file.write_bytes(bytes(bad))
            try:
                sw.read(file, max_memory=1e8) if suffix == "usdc" else read_texture(file, budget=Budget(1e8))
                read_layers(file) if suffix == "exr" else None
            except (ValueError, OSError) as error:
                refused += 1
                assert file.name in str(error) and "\n" not in str(error)
    assert refused > 20


def package(path, entries, compression=zipfile.ZIP_STORED):
    with zipfile.ZipFile(path, "w", compression) as archive:
        for name, data in entries.items():
            archive.writestr(name, data)
    return path


@pytest.mark.parametrize(
    ("entries", "compression", "said"),
    [
        ({"a.usda": "#usda 1.0\n", "bomb.png": b"\0" * 30_000_000}, zipfile.ZIP_DEFLATED, "is compressed"),
        ({"a.usda": "#usda 1.0\n", "../../out.png": b"x"}, zipfile.ZIP_STORED, "outside of the package"),
        ({"a.usda": "#usda 1.0\n", "/etc/out.png": b"x"}, zipfile.ZIP_STORED, "outside of the package"),
    ],
)
def test_packages(tmp_path, entries, compression, said):
    path = package(tmp_path / "trap.usdz", entries, compression)
    with pytest.raises(sw.scene.StageError, match=rf"trap.usdz: .*{said}"):
        sw.read(path)


def test_a_package_that_claims_more_than_it_holds(tmp_path):
    path = package(tmp_path / "trap.usdz", {"a.usda": "#usda 1.0\n", "b.png": b"x" * 50})
    data = bytearray(path.read_bytes())
    at = data.rindex(b"PK\x01\x02")
    data[at + 20 : at + 28] = struct.pack("<II", 0x7000_0000, 0x7000_0000)
    path.write_bytes(data)
    with pytest.raises(sw.scene.StageError, match="claim 1879048202 bytes"):
        sw.read(path)
    path.write_bytes(b"no zip at all")
    with pytest.raises(sw.scene.StageError, match="is no USD package"):
        sw.read(path)


def test_a_package_as_it_should_be(tmp_path):
    out = oiio.ImageOutput.create(str(tmp_path / "grey.png"))
    out.open(str(tmp_path / "grey.png"), oiio.ImageSpec(4, 4, 3, oiio.UINT8))
    out.write_image(np.full((4, 4, 3), 128, np.uint8))
    out.close()
    assert UsdUtils.CreateNewUsdzPackage(str(stage(tmp_path, "grey.png")), str(tmp_path / "good.usdz"))
    before = {p.name: p.read_bytes() for p in tmp_path.iterdir()}
    assert len(sw.read(tmp_path / "good.usdz").textures) == 1
    assert {p.name: p.read_bytes() for p in tmp_path.iterdir()} == before, "reading writes nothing"


class Trap:
    """Unpickled, it would run code."""

    def __reduce__(self):
        return (exec, ("raise SystemError('code was run')",))


def test_a_baked_table_runs_no_code():
    held = io.BytesIO()
    np.savez(held, by_bounce=np.array([Trap()], dtype=object), lost=np.zeros(1))
    held.seek(0)
    with pytest.raises(ValueError, match="allow_pickle"):
        read_table(held)
    with pytest.raises(SystemError):  # such a trap works where pickles are loaded
        pickle.loads(pickle.dumps(Trap()))


def test_sizes():
    assert [parsed(text) for text in ("8G", "500m", "1e9", "2 TB")] == [8e9, 5e8, 1e9, 2e12]
    for wrong in ("", "G", "-1G", "8X", "nan", "0"):
        with pytest.raises(ValueError, match="no size such as"):
            parsed(wrong)
    assert [spelled(size) for size in (12, 1500, 2.5e9)] == ["12 bytes", "1.5 KB", "2.5 GB"]
    budget = Budget(100)
    budget.take(60, "a", "this")
    with pytest.raises(TooLarge, match="b: that would take 50 bytes; 100 bytes are allowed, 60 bytes are taken"):
        budget.take(50, "b", "that")
    budget.fresh().take(90, "c", "then")
