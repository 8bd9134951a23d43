
local function register(kind)
    local texture = "orogen_blocks_grain.png^[multiply:" .. kind.color
    local definition = {
        description = kind.name:gsub("_", " "),
        tiles = { texture },
        groups = { oddly_breakable_by_hand = 3, handy = 1 },
        is_ground_content = true,
    }
    if kind.name == "water" then
        definition.drawtype = "liquid"
        definition.use_texture_alpha = "blend"
        definition.tiles = { texture .. "^[opacity:160" }
        definition.special_tiles = { texture .. "^[opacity:160", texture .. "^[opacity:160" }
        definition.paramtype = "light"
        definition.walkable = false
        definition.pointable = false
        definition.buildable_to = true
        definition.liquidtype = "source"
        definition.liquid_alternative_source = "orogen_blocks:water"
        definition.liquid_alternative_flowing = "orogen_blocks:water_flowing"
        definition.liquid_viscosity = 1
        definition.post_effect_color = { a = 100, r = 30, g = 60, b = 90 }
        definition.groups = { water = 3, liquid = 3 }
    elseif kind.name == "leaves" or kind.name == "needles" then
        definition.drawtype = "allfaces_optional"
        definition.paramtype = "light"
    end
    minetest.register_node("orogen_blocks:" .. kind.name, definition)
    if kind.name == "water" then
        local flowing = table.copy(definition)
        flowing.drawtype = "flowingliquid"
        flowing.paramtype2 = "flowingliquid"
        flowing.liquidtype = "flowing"
        minetest.register_node("orogen_blocks:water_flowing", flowing)
    end
end

for _, kind in ipairs(kinds) do
    local known
    for _, name in ipairs(kind.games) do
        known = known or minetest.registered_nodes[name] and name
    end
    if known then
        minetest.register_alias("orogen_blocks:" .. kind.name, known)
    else
        register(kind)
    end
end

local function place(player)
    player:set_pos(spawn)
    return true
end
minetest.register_on_newplayer(place)
minetest.register_on_respawnplayer(place)
