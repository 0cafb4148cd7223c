use <lib/no_such_font.ttf>
echo("still here");
