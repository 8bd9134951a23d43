//! The kinds of files that blocks are written to.

/// The kinds of files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum BlockFormat {
    /// MagicaVoxel models.
    Vox,
    /// A Sponge schematic, version 3, for Minecraft: Java Edition.
    Schem,
    /// The smooth surface of the ground as a mesh.
    Glb,
    /// A picture: from the south-east, or a vertical section.
    Png,
    /// A folder with a Luanti (Minetest) world.
    Luanti,
    /// A folder with a save of Minecraft: Java Edition.
    Minecraft,
}

impl BlockFormat {
    /// All kinds.
    pub const ALL: [BlockFormat; 6] = [
        BlockFormat::Vox,
        BlockFormat::Schem,
        BlockFormat::Glb,
        BlockFormat::Png,
        BlockFormat::Luanti,
        BlockFormat::Minecraft,
    ];

    /// The kinds that are single files.
    pub const FILES: [BlockFormat; 4] = [BlockFormat::Vox, BlockFormat::Schem, BlockFormat::Glb, BlockFormat::Png];

    /// Its name, which is also the extension of a single file.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            BlockFormat::Vox => "vox",
            BlockFormat::Schem => "schem",
            BlockFormat::Glb => "glb",
            BlockFormat::Png => "png",
            BlockFormat::Luanti => "luanti",
            BlockFormat::Minecraft => "minecraft",
        }
    }

    /// What it is, in a line.
    #[must_use]
    pub fn about(self) -> &'static str {
        match self {
            BlockFormat::Vox => "MagicaVoxel models (.vox)",
            BlockFormat::Schem => "A Sponge schematic, version 3, for Minecraft: Java Edition (.schem)",
            BlockFormat::Glb => "The smooth surface of the ground as a mesh (.glb)",
            BlockFormat::Png => "A picture from the south-east (.png)",
            BlockFormat::Luanti => "A folder with a Luanti (Minetest) world",
            BlockFormat::Minecraft => "A folder with a save of Minecraft: Java Edition",
        }
    }

    /// Whether it is a folder.
    #[must_use]
    pub fn is_folder(self) -> bool {
        matches!(self, BlockFormat::Luanti | BlockFormat::Minecraft)
    }
}
