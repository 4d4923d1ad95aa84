# Loads a map as a PanoramaSky and prints the colours that cameras see toward directions.
# Run as: godot3 --path EMPTY_FOLDER -s godot_directions.gd MAP DIRECTIONS.json RESULT.json
extends SceneTree

func _initialize():
	call_deferred("_run")

func _run():
	var arguments = OS.get_cmdline_args()
	var count = arguments.size()
	var image = Image.new()
	if image.load(arguments[count - 3]) != OK:
		quit(1)
		return
	var texture = ImageTexture.new()
	texture.create_from_image(image, Texture.FLAG_FILTER | Texture.FLAG_REPEAT)
	var sky = PanoramaSky.new()
	sky.panorama = texture
	var environment = Environment.new()
	environment.background_mode = Environment.BG_SKY
	environment.background_sky = sky
	environment.tonemap_mode = Environment.TONE_MAPPER_LINEAR
	var viewport = Viewport.new()
	viewport.size = Vector2(8, 8)
	viewport.own_world = true
	viewport.usage = Viewport.USAGE_3D
	viewport.hdr = true
	viewport.render_target_update_mode = Viewport.UPDATE_ALWAYS
	get_root().add_child(viewport)
	var camera = Camera.new()
	camera.environment = environment
	camera.fov = 1.0
	viewport.add_child(camera)
	camera.make_current()
	var file = File.new()
	file.open(arguments[count - 2], File.READ)
	var directions = JSON.parse(file.get_as_text()).result
	file.close()
	var colours = []
	for one in directions:
		camera.look_at_from_position(Vector3(), Vector3(one[0], one[1], one[2]), Vector3(0, 1, 0))
		for _i in range(3):
			yield(self, "idle_frame")
		var seen = viewport.get_texture().get_data()
		seen.lock()
		var colour = seen.get_pixel(4, 4)
		seen.unlock()
		colours.append([colour.r, colour.g, colour.b])
	file.open(arguments[count - 1], File.WRITE)
	file.store_string(to_json({"version": Engine.get_version_info().string, "colours": colours}))
	file.close()
	quit()
