"""Body files with fewer modes than were computed (docs/file_format.md lists the datasets)."""
import h5py

# Large, or of all modes together, and not needed by simulate at its default inertia level.
LEFT_OUT = {"checks", "reduced/S_2", "surface/bounds"}
# Datasets with an axis of modes, and which.
MODE_AXES = {"modes/Phi": (0,), "reduced/M": (0, 1), "reduced/K": (0, 1), "reduced/C_l": (0,), "reduced/C_r": (0,), "reduced/S_1": (0,),
             "modes/frequency": (0,), "modes/eigenvalue": (0,), "surface/Phi": (2,), "stress/Psi": (2,)}


def cut(source, target, n, fields=False):
    """Writes the body file `source` with its first n modes only; fields: with their values at all nodes, too."""
    left_out = LEFT_OUT if fields else LEFT_OUT | {"modes/Phi"}
    with h5py.File(source) as old, h5py.File(target, "w") as new:
        def copy(name, item):
            if any(name == left or name.startswith(left + "/") for left in left_out):
                return
            if isinstance(item, h5py.Group):
                made = new.require_group(name)
            else:
                is_part = name.startswith("relaxing/") and name.endswith("/K")
                axes = (0, 1) if is_part else MODE_AXES.get(name, ())
                made = new.create_dataset(name, data=item[tuple(slice(n) if i in axes else slice(None)
                                                                for i in range(item.ndim))],
                                            dtype=item.dtype)
            for key, value in item.attrs.items():
                made.attrs.create(key, value, dtype=item.attrs.get_id(key).dtype, shape=item.attrs.get_id(key).shape)
        for key in old.attrs:
            new.attrs.create(key, old.attrs[key], dtype=old.attrs.get_id(key).dtype, shape=old.attrs.get_id(key).shape)
        old.visititems(copy)
